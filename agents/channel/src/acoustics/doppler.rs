//! How motion stretches and squeezes sound.
