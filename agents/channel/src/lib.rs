//! The water: true bodies, true clocks, sensors, sound and time. A pure state machine.
//!
//! [`Channel`](channel::Channel) owns the truth. It advances true time in windows, tells each AUV what it senses, takes what
//! each decides, delays every ping by the range between emitter and receiver while both move, and compares every enclosure
//! that an AUV states with the truth. Nothing in here reads a wall clock or opens a file, and no AUV code is reachable from
//! here. With the feature `parallel`, pieces of the swarm are worked on side by side, which no result depends on.
//!
//! | file | idea |
//! |---|---|
//! | `acoustics/` | the physics of sound |
//! | `channel.rs` | windows, wakes, answers |
//! | `bearing.rs` | directions from which pings arrive |
//! | `birth.rs` | from scenario to newborn AUVs |
//! | `vehicle.rs` | one AUV as the water knows it |
//! | `water.rs` | what the water really is |
//! | `current.rs` | the true current |
//! | `body.rs` | true motion |
//! | `clock.rs` | true clocks |
//! | `sensors.rs` | measurements inside stated bounds |
//! | `sound.rs` | wavefronts and arrivals |
//! | `reception.rs` | which packets a modem decodes |
//! | `assumption.rs` | what assuming few outliers is worth |
//! | `exposure.rs` | what false pings do to a promise |
//! | `check.rs` | enclosures against the truth |
//! | `grid.rs` | who is near |
//! | `ideal.rs` | sound as a sphere with a sharp edge |
//! | `medium.rs` | either level behind one face |
//! | `parallel.rs` | pieces of the swarm side by side |
//! | `budget.rs` | the sonar equation |
//! | `sea.rs` | sound as in water |
//! | `flock.rs` | separation, alignment, connectivity |
//! | `draw.rs` | reproducible randomness |
//! | `digest.rs` | one hash of everything |
//! | `accuracy.rs` | how good estimates are |
//! | `tally.rs` | what it all amounts to |

pub mod accuracy;
pub mod acoustics;
mod assumption;
pub mod bearing;
pub mod birth;
pub mod body;
pub mod budget;
pub mod channel;
pub mod check;
pub mod clock;
pub mod current;
mod deadlines;
pub mod digest;
pub mod draw;
mod exposure;
pub mod flock;
pub mod grid;
mod ideal;
mod medium;
mod parallel;
pub mod reception;
mod sea;
pub mod sensors;
pub mod sound;
mod tally;
pub mod vehicle;
pub mod water;
