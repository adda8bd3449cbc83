//! The two times of a run, which never mix: the water's and an AUV's own.

use std::fmt;
use std::ops::{Add, Sub};

use serde::{Deserialize, Serialize};

/// Nanoseconds in one second.
pub const NS_PER_S: i64 = 1_000_000_000;

macro_rules! instant {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(i64);

        impl $name {
            /// Where this time begins.
            pub const ZERO: Self = Self(0);

            /// The instant `ns` nanoseconds after zero.
            pub const fn from_ns(ns: i64) -> Self {
                Self(ns)
            }

            /// Nanoseconds since zero.
            pub const fn ns(self) -> i64 {
                self.0
            }

            /// Seconds since zero, rounded to the nearest `f64`: for display and for physics whose bounds say so.
            pub fn as_s(self) -> f64 {
                self.0 as f64 / NS_PER_S as f64
            }
        }

        impl Add<i64> for $name {
            type Output = Self;
            /// Moves the instant by so many nanoseconds.
            fn add(self, ns: i64) -> Self {
                Self(self.0 + ns)
            }
        }

        impl Sub for $name {
            type Output = i64;
            /// Nanoseconds from `earlier` to this instant.
            fn sub(self, earlier: Self) -> i64 {
                self.0 - earlier.0
            }
        }

        impl fmt::Display for $name {
            /// Seconds with the nine digits that nanoseconds need.
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                let sign = if self.0 < 0 { "-" } else { "" };
                let ns = self.0.unsigned_abs();
                write!(f, "{sign}{}.{:09}", ns / NS_PER_S as u64, ns % NS_PER_S as u64)
            }
        }
    };
}

instant! {
    /// True time, in nanoseconds. Only the channel and observers of the truth hold it; an AUV never does.
    ///
    /// ```
    /// use shoal_bus::time::SimTime;
    /// assert_eq!((SimTime::from_ns(1_500_000_000) + 5).to_string(), "1.500000005");
    /// ```
    SimTime
}

instant! {
    /// What one AUV's own clock reads, in nanoseconds. Readings of two AUVs are not comparable.
    ///
    /// ```
    /// use shoal_bus::time::LocalTime;
    /// assert_eq!(LocalTime::from_ns(30) - LocalTime::from_ns(10), 20);
    /// ```
    LocalTime
}
