//! A run whose launcher is killed ends and cleans up after itself. The only test in its file: every `shoal run` sweeps up what dead
//! runs left, and one started by a test beside this one would hide that nobody else did.

use rustix::process::Signal;
use shoal_tests::Command;

#[test]
fn all_end_and_nothing_stays() {
    for bus in ["iceoryx2", "zenoh"] {
        let mut live = Command::new("run six-circles --pace 5 --json --bus").with(bus).start();
        live.await_pings(6);
        assert_eq!(live.children().len(), 7);
        live.signal(Signal::KILL);
        // Waits for the end of all seven, and until nothing is left.
        let finished = live.finish();
        assert_eq!((finished.code(), finished.stdout.as_str()), (None, ""));
    }
}
