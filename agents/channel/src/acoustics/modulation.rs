//! Bit and packet errors of a modem's modulation.
