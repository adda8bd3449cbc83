//! The bytes of a record depend on what happened alone, and reach the operating system every simulated second.

use std::cell::RefCell;
use std::io::{BufWriter, Cursor, Write};
use std::rc::Rc;

use super::synthetic::{header, run, write};
use crate::record::{RecordInfo, RecordWriter};
use crate::time::SimTime;

#[test]
fn equal_runs_leave_equal_bytes() {
    let file = write(7, &run(7, 3), 100_000_000);
    assert!(file == write(7, &run(7, 3), 100_000_000));
    assert!(file != write(7, &run(7, 2), 100_000_000));
}

#[test]
fn windows_leave_no_trace() {
    let entries = run(7, 3);
    let file = write(7, &entries, 100_000_000);
    for window_ns in [1_000_000, 37_123_457, 99_999_999, 130_000_001, 1_000_000_000, 10_000_000_000] {
        assert!(file == write(7, &entries, window_ns), "windows of {window_ns} ns");
    }
}

/// A file of which one sees what has reached the operating system.
#[derive(Clone, Default)]
struct Disk(Rc<RefCell<Vec<u8>>>);

impl Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.borrow_mut().extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn every_complete_second_has_reached_the_disk() {
    let entries = run(7, 3);
    let disk = Disk::default();
    let mut writer =
        RecordWriter::create(BufWriter::with_capacity(16 << 20, disk.clone()), &header(7)).unwrap();
    for second in 1..=3 {
        let border = SimTime::from_ns(second * 1_000_000_000 + 1);
        let window: Vec<_> = entries
            .iter()
            .filter(|entry| entry.at < border && border - entry.at <= 1_000_000_000)
            .cloned()
            .collect();
        writer.append(&window).unwrap();
        writer.advance(border).unwrap();
        let info = RecordInfo::read(Cursor::new(disk.0.borrow().clone())).unwrap();
        assert_eq!(info.truncated.unwrap().readable_until_s, Some(second as f64));
    }
    drop(writer);
    let info = RecordInfo::read(Cursor::new(disk.0.borrow().clone())).unwrap();
    assert_eq!((info.truncated, info.digest.as_deref()), (None, None));
    assert!(info.to_string().contains("the run did not finish"));
}
