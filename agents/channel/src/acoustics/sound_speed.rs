//! Speed of sound in sea water.
