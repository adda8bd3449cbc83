//! The key `relative` of a group: whether, and by what, its AUVs enclose their neighbours in their own frames.

use toml::de::DeValue;

use crate::model::{Measures, Modem, Relative};
use crate::reader::Table;

pub(crate) const MEASURES: &[(&str, Measures)] = &[
    ("range-and-bearing", Measures::RangeAndBearing),
    ("bearing", Measures::Bearing),
    ("range", Measures::Range),
];
/// More cost more than they tell: what happened since has worn the older ones wide.
pub(crate) const REMEMBERED_MAX: u64 = 256;

pub(crate) fn relative(group: &Table<'_>, modem: Option<&Modem>) -> Option<Option<Relative>> {
    match group.get("relative").map(toml::Spanned::get_ref) {
        None | Some(DeValue::Boolean(false)) => return Some(None),
        Some(_) => {}
    }
    let table = group.table("relative", "[group.relative]")?;
    let measures = table.choice("measures", MEASURES, Measures::RangeAndBearing);
    let exchanged = table.boolean("exchanged", true);
    let remembered = table.whole("remembered", Some(16), 1, REMEMBERED_MAX);
    table.finish();
    if let (Some(modem), Some(measures)) = (modem, measures)
        && measures != Measures::Range
        && modem.bearing_error_rad.is_none()
    {
        group.refuse(
            "relative",
            "neighbours are to be followed by bearings, but the modem measures none",
            "needs a modem with an array",
            "write `modem.bearing_error_rad = 0.1`, or `measures = \"range\"`",
        );
        return None;
    }
    Some(Some(Relative { measures: measures?, exchanged: exchanged?, remembered: remembered? as u16 }))
}
