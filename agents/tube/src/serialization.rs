//! Time domains and tubes in files and messages: checked when they are read.
//!
//! A domain is either `{ start_s, step_s, count }` or a list of borders. A tube is its domain, its slices and its gates;
//! whatever of a gate is not inside the slices beside it is removed on reading. An unbounded or empty set has infinite
//! bounds, so the format must be able to hold infinities.

use crate::enclosure::Enclosure;
use crate::error::TubeError;
use crate::time_domain::TimeDomain;
use crate::tube::Tube;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

#[derive(Serialize, Deserialize)]
enum WrittenDomain {
    Uniform { start_s: f64, step_s: f64, count: usize },
    Borders(Vec<f64>),
}

#[derive(Serialize, Deserialize)]
struct WrittenTube<T> {
    domain: TimeDomain,
    slices: Vec<T>,
    gates: Vec<T>,
}

impl Serialize for TimeDomain {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let written = match self.as_uniform() {
            Some((start_s, step_s, count)) => WrittenDomain::Uniform { start_s, step_s, count },
            None => WrittenDomain::Borders(self.borders_s().collect()),
        };
        written.serialize(serializer)
    }
}

/// Refuses what [`TimeDomain::uniform`] and [`TimeDomain::new`] refuse.
impl<'de> Deserialize<'de> for TimeDomain {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<TimeDomain, D::Error> {
        match WrittenDomain::deserialize(deserializer)? {
            WrittenDomain::Uniform { start_s, step_s, count } => TimeDomain::uniform(start_s, step_s, count),
            WrittenDomain::Borders(borders_s) => TimeDomain::new(borders_s),
        }
        .map_err(D::Error::custom)
    }
}

impl<T: Enclosure + Serialize> Serialize for Tube<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        WrittenTube {
            domain: self.domain.clone(),
            slices: self.slices().collect(),
            gates: self.gates().collect(),
        }
        .serialize(serializer)
    }
}

/// Refuses what [`Tube::from_parts`] refuses.
impl<'de, T: Enclosure + Deserialize<'de>> Deserialize<'de> for Tube<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Tube<T>, D::Error> {
        let written = WrittenTube::deserialize(deserializer)?;
        let tube: Result<Tube<T>, TubeError> =
            Tube::from_parts(written.domain, written.slices, written.gates);
        tube.map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shoal_interval::{Interval, IntervalBox};

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    #[test]
    fn what_is_written_is_read() {
        let ramp = Tube::from_function(TimeDomain::uniform(0.5, 0.25, 8).unwrap(), |time| time);
        let mut cut = ramp.clone();
        cut.refine([0.7]).unwrap();
        cut.drop_front(1);
        let mut dropped = ramp.clone();
        dropped.drop_front(3);
        for tube in [ramp, cut, dropped] {
            let text = serde_json::to_string(&tube).unwrap();
            assert_eq!(serde_json::from_str::<Tube<Interval>>(&text).unwrap(), tube, "{text}");
        }
    }

    #[test]
    fn vectors_are_written_too() {
        let time = TimeDomain::uniform(0.0, 1.0, 3).unwrap();
        let position = Tube::from_function(time, |time| IntervalBox::from([time, time.sqr()]));
        let text = serde_json::to_string(&position).unwrap();
        assert_eq!(serde_json::from_str::<Tube<IntervalBox<2>>>(&text).unwrap(), position);
    }

    #[test]
    fn what_is_read_is_checked() {
        let read = |domain: &str, slices: &str, gates: &str| {
            let text = format!("{{\"domain\":{domain},\"slices\":{slices},\"gates\":{gates}}}");
            serde_json::from_str::<Tube<Interval>>(&text).map_err(|error| error.to_string())
        };
        let borders = r#"{"Borders":[0,1]}"#;
        let tube = read(borders, "[[0,2]]", "[[1,3],[0,1]]").unwrap();
        assert_eq!(tube.gate(0), Some(over(1.0, 2.0)));
        let error = |domain, slices, gates| read(domain, slices, gates).unwrap_err();
        assert!(error(r#"{"Borders":[1,0]}"#, "[[0,2]]", "[[1,3],[0,1]]").contains("must increase"));
        assert!(error(r#"{"Borders":[]}"#, "[]", "[]").contains("at least one border"));
        assert!(error(borders, "[[0,2]]", "[[1,3]]").contains("one gate more"));
        assert!(error(borders, "[[2,0]]", "[[1,3],[0,1]]").contains("lower"));
        let endless = r#"{"Uniform":{"start_s":0,"step_s":1,"count":1000000000000}}"#;
        assert!(error(endless, "[]", "[[0,1]]").contains("1000000000000 slices"));
        let tiny = r#"{"Uniform":{"start_s":1e9,"step_s":1e-9,"count":5}}"#;
        assert!(error(tiny, "[]", "[[0,1]]").contains("large enough"));
    }
}
