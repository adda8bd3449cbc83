//! Density of sea water.
