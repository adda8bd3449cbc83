//! Speed of sound over depth.
