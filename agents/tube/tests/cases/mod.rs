//! How many cases the property tests draw.

/// The number in the environment variable `SHOAL_TUBE_CASES`, or the one that a quick run needs.
pub fn cases(quick: u32) -> u32 {
    std::env::var("SHOAL_TUBE_CASES").ok().and_then(|number| number.parse().ok()).unwrap_or(quick)
}
