//! The water of a recorded run: what its scenario says, settled by its seed.

use shoal_bus::record::RecordHeader;
use shoal_channel::water::Water;
use shoal_scenario::parse;

/// The water of the run that left a record. Otherwise a sentence that says what is wrong.
pub fn water(header: &RecordHeader) -> Result<Water, String> {
    let mut scenario = parse("scenario.toml of the record", &header.scenario_text)
        .map_err(|errors| format!("this version of shoal does not read the record's scenario\n{errors}"))?;
    scenario.seed = header.seed;
    Water::new(&scenario).map_err(|error| error.to_string())
}
