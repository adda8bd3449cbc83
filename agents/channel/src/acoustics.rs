//! The physics of sound in the sea, as pure functions: nothing in here knows of AUVs, pings or scenarios.
//!
//! | file | idea |
//! |---|---|
//! | `sound_speed.rs` | speed of sound from temperature, salinity and depth |
//! | `profile.rs` | speed of sound over depth, piecewise linear |
//! | `ray.rs` | exact rays in a profile: travel time, bending, bounces |
//! | `absorption.rs` | what sea water swallows |
//! | `reflection.rs` | what surface and bottom give back |
//! | `noise.rs` | ambient noise |
//! | `modulation.rs` | bit and packet errors |
//! | `doppler.rs` | stretch by motion |
//! | `density.rs` | density of sea water |
//! | `decibel.rs` | levels and power ratios |

pub mod absorption;
pub mod decibel;
pub mod density;
pub mod doppler;
pub mod modulation;
pub mod noise;
pub mod profile;
pub mod ray;
pub mod reflection;
pub mod sound_speed;
