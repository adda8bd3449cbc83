//! What surface and bottom give back of sound.
