//! What a scenario knows of the messages without knowing the bus is what the bus says of them.

use shoal_bus::ping;

#[test]
fn a_ping_and_the_longest_frame_have_the_lengths_that_scenarios_are_checked_against() {
    assert_eq!(usize::from(shoal_scenario::PING_BYTES), ping::FRAME_BYTES);
    assert_eq!(usize::from(shoal_scenario::FRAME_BYTES_MAX), ping::FRAME_BYTES_MAX);
}
