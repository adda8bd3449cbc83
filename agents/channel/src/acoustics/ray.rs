//! Exact rays in piecewise-linear profiles.
