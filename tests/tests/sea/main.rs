//! Sound at level `sea` as whole runs show it: it keeps the laws of sound, and every ping that is lost is explained.

mod edges;
mod laws;
mod meetings;
mod runs;
