//! Ambient noise of the sea.
