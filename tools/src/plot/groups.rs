//! How the groups of a run look in every figure: a colour each, and a shape.

use shoal_bus::message::AuvId;
use shoal_bus::record::{RecordHeader, RecordedAuv};

use crate::figure::{Colour, Mark, Shape};

const COLOURS: [Colour; 8] = [
    Colour::Blue,
    Colour::Vermillion,
    Colour::Green,
    Colour::Orange,
    Colour::Purple,
    Colour::Sky,
    Colour::Black,
    Colour::Grey,
];

const SHAPES: [Shape; 5] = [Shape::Disc, Shape::Triangle, Shape::Square, Shape::Diamond, Shape::Plus];

/// The colour of a group, by its index.
pub fn colour(group: u16) -> Colour {
    COLOURS[usize::from(group) % COLOURS.len()]
}

/// The mark of a group's AUVs, by its index.
pub fn mark(group: u16) -> Mark {
    Mark::new(SHAPES[usize::from(group) % SHAPES.len()], colour(group))
}

/// Index and name of each group that has AUVs, in the order of the scenario.
pub fn groups(header: &RecordHeader) -> Vec<(u16, &str)> {
    let mut groups: Vec<(u16, &str)> =
        header.auvs.iter().map(|auv| (auv.group, auv.group_name.as_str())).collect();
    groups.sort_unstable();
    groups.dedup();
    groups
}

/// What is told of an AUV, or a sentence that says which there are.
pub fn told(header: &RecordHeader, auv: AuvId) -> Result<&RecordedAuv, String> {
    header
        .auvs
        .get(auv.0 as usize)
        .ok_or_else(|| format!("there is no AUV {auv}: the record has {}, counted from 0", header.auvs.len()))
}
