//! What travel times say of ranges, against the truth: the long way round stands out.

use std::collections::BTreeMap;

use shoal_bus::record::rows::PingRow;
use shoal_bus::record::{RecordHeader, Row, Topic};

use super::Plot;
use super::thinned::Thinned;
use super::water::water;
use super::way::Way;
use crate::figure::{Axis, Colour, Entry, Figure, Layer, Mark, Panel, Sample, Shape};

/// True range and travel time of every ping that was heard.
#[derive(Default)]
pub struct Ranges {
    /// By whether it is an outlier, then by way: range in metres, travel time in seconds.
    series: BTreeMap<(bool, Way), Thinned>,
    farthest_m: f64,
}

impl Plot for Ranges {
    fn topics(&self) -> &'static [Topic] {
        &[Topic::Pings]
    }

    fn take(&mut self, row: &Row) {
        let Row::Ping(PingRow::Heard { range_m, travel_s, reception, outlier, .. }) = row else { return };
        let way = Way::of(reception.as_ref().map(|reception| &*reception.path));
        self.series.entry((*outlier, way)).or_default().push([range_m.0, travel_s.0]);
        self.farthest_m = self.farthest_m.max(range_m.0);
    }

    fn figure(self: Box<Self>, header: &RecordHeader) -> Result<Figure, String> {
        if self.series.is_empty() {
            return Err("nothing to show: no ping was heard".to_owned());
        }
        let stated = water(header)?.told_sound_speed_m_s;
        let mean_m_s = stated.mid();
        // The excess of an honest range: travel_s lies in [range / upper, range / lower].
        let excess_m = |range_m: f64, speed_m_s: f64| range_m * (mean_m_s / speed_m_s - 1.0);
        let corner = |range_m, speed_m_s| [range_m, excess_m(range_m, speed_m_s)];
        let farthest_m = self.farthest_m;
        let honest = vec![[0.0, 0.0], corner(farthest_m, stated.upper), corner(farthest_m, stated.lower)];
        let (mut least_m, mut greatest_m) = (honest[1][1].min(0.0), honest[2][1].max(0.0));
        let mut layers = vec![
            Layer::Area { colour: Colour::Pale, corners: honest },
            Layer::Line { colour: Colour::Grey, points: vec![[0.0, 0.0], [farthest_m, 0.0]] },
        ];
        let mut legend = Vec::new();
        for (&(is_outlier, way), series) in &self.series {
            let excess = |&[range_m, travel_s]: &[f64; 2]| [range_m, travel_s * mean_m_s - range_m];
            let points: Vec<[f64; 2]> = series.points().iter().map(excess).collect();
            for [_, excess_m] in &points {
                least_m = least_m.min(*excess_m);
                greatest_m = greatest_m.max(*excess_m);
            }
            let mark = Mark::new(if is_outlier { Shape::Cross } else { Shape::Disc }, way.colour());
            let name = format!("{}{}", way.name(), if is_outlier { ", outlier" } else { "" });
            legend.push(Entry::new(Sample::Mark(mark), series.legend(&name)));
            layers.push(Layer::Marks { mark, points });
        }
        let bounds = format!("what {:.2} to {:.2} m/s allows", stated.lower, stated.upper);
        legend.push(Entry::new(Sample::Area(Colour::Pale), bounds));
        let y_label = format!("travel time × {mean_m_s:.2} m/s, minus true range (m)");
        let panel = Panel {
            width_px: 640.0,
            x: Axis::from_zero("true range (m)", farthest_m),
            y: Axis::around(y_label, least_m, greatest_m),
            layers,
        };
        Ok(Figure {
            title: "What travel times say of ranges".to_owned(),
            subtitle: String::new(),
            panels: vec![panel],
            legend,
        })
    }
}
