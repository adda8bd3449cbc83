//! Levels in decibels and the power ratios that they stand for.

/// The power ratio of a level: 10^(level / 10).
///
/// ```
/// use shoal_channel::acoustics::decibel::power_from_db;
///
/// assert_eq!(power_from_db(20.0), 100.0);
/// ```
pub fn power_from_db(level_db: f64) -> f64 {
    pxfm::f_exp10(level_db / 10.0)
}

/// The level of a power ratio: 10 lg ratio; minus infinity for none.
///
/// ```
/// use shoal_channel::acoustics::decibel::db_from_power;
///
/// assert_eq!(db_from_power(0.1), -10.0);
/// ```
pub fn db_from_power(ratio: f64) -> f64 {
    10.0 * pxfm::f_log10(ratio)
}
