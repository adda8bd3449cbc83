//! What becomes of a ping at a receiver, and how that looks in every figure.

use std::collections::BTreeMap;

use shoal_bus::record::rows::PingRow;
use shoal_bus::traffic::LossReason;

use super::thinned::Thinned;
use crate::figure::{Colour, Entry, Layer, Mark, Sample, Shape};

/// What becomes of a ping at a receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fate {
    /// It is heard.
    Heard,
    /// It is not.
    Lost(LossReason),
}

impl Fate {
    /// The fate that a row tells of; `None` for an emission, and for a ping that never left.
    pub fn of(row: &PingRow) -> Option<Self> {
        match row {
            PingRow::Heard { .. } => Some(Self::Heard),
            PingRow::Lost { to: Some(_), reason, .. } => Some(Self::Lost(*reason)),
            PingRow::Emitted { .. } | PingRow::Lost { to: None, .. } => None,
        }
    }

    /// As legends say it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Heard => "heard",
            Self::Lost(reason) => match reason {
                LossReason::Range => "out of range",
                LossReason::Noise => "lost in noise",
                LossReason::Collision => "lost by collision",
                LossReason::HalfDuplex => "lost, receiver emitting",
                LossReason::Shadow => "lost in a shadow zone",
                LossReason::Asleep => "lost, receiver asleep",
                LossReason::Band => "lost, other band",
                LossReason::Busy => "held back, others heard",
                LossReason::Late => "booked too late",
                LossReason::Dead => "lost, receiver dead",
            },
        }
    }

    /// As figures show it.
    pub fn mark(self) -> Mark {
        match self {
            Self::Heard => Mark::new(Shape::Disc, Colour::Blue),
            Self::Lost(reason) => match reason {
                LossReason::Range => Mark::new(Shape::Ring, Colour::Pale),
                LossReason::Noise => Mark::new(Shape::Triangle, Colour::Orange),
                LossReason::Collision => Mark::new(Shape::Cross, Colour::Vermillion),
                LossReason::HalfDuplex => Mark::new(Shape::Square, Colour::Purple),
                LossReason::Shadow => Mark::new(Shape::Plus, Colour::Black),
                LossReason::Asleep => Mark::new(Shape::Diamond, Colour::Green),
                LossReason::Band => Mark::new(Shape::Diamond, Colour::Yellow),
                LossReason::Busy => Mark::new(Shape::Square, Colour::Sky),
                LossReason::Late => Mark::new(Shape::Ring, Colour::Sky),
                LossReason::Dead => Mark::new(Shape::Ring, Colour::Grey),
            },
        }
    }
}

/// A layer of marks and a line of the legend for each fate; the rarest lies on top.
pub fn by_fate(series: &BTreeMap<Fate, Thinned>) -> (Vec<Layer>, Vec<Entry>) {
    let legend = series
        .iter()
        .map(|(fate, series)| Entry::new(Sample::Mark(fate.mark()), series.legend(fate.name())))
        .collect();
    let mut sorted: Vec<(&Fate, &Thinned)> = series.iter().collect();
    sorted.sort_by_key(|(_, series)| std::cmp::Reverse(series.count()));
    let layer = |(fate, series): (&Fate, &Thinned)| Layer::Marks {
        mark: fate.mark(),
        points: series.points().to_vec(),
    };
    (sorted.into_iter().map(layer).collect(), legend)
}
