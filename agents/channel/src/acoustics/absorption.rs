//! What sea water swallows of sound.
