//! An unknown heading at the start, found by set inversion.

use shoal_interval::Interval;

use super::tube::tube;
use super::{Mission, Start, TubeSettings};

/// How to look for a heading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadingSearch {
    /// Sectors narrower than this are not halved any more, in radians.
    pub precision_rad: f64,
}

/// The headings at the start, in radians, with which no window of the whole mission contradicts the settings: the hull of all sectors
/// that the tube survives, or nothing.
///
/// Sectors of the heading are halved until a tube that begins in them is emptied, or they are narrow enough. Exact as the
/// tube is: a sector is thrown away only when it breaks the assumption about outliers.
///
/// Source: seed 002, algorithm 4.2 (RTubeCSIVIA), with the tube as contractor of the heading.
pub fn search_heading(
    mission: &Mission,
    start: &Start,
    settings: &TubeSettings,
    search: &HeadingSearch,
) -> Interval {
    let online = TubeSettings { smoothed: false, ..*settings };
    let mut found = Interval::EMPTY;
    let mut sectors = vec![start.heading_rad];
    while let Some(heading_rad) = sectors.pop() {
        if heading_rad.is_subset_of(found) {
            continue;
        }
        let survives = tube(mission, &Start { heading_rad, ..*start }, &online).emptied.is_empty();
        if !survives {
            continue;
        }
        match heading_rad.bisect().filter(|_| heading_rad.width() > search.precision_rad) {
            Some((low, high)) => sectors.extend([low, high]),
            None => found = found | heading_rad,
        }
    }
    found
}
