//! Memory that grows in small steps.

use std::collections::VecDeque;

/// Adds a value at the end. A full deque grows by a quarter, not to the double: constant time on average all the same, and
/// what is unused stays small.
pub(crate) fn push_sparingly<V>(deque: &mut VecDeque<V>, value: V) {
    if deque.len() == deque.capacity() {
        deque.reserve_exact((deque.len() / 4).max(4));
    }
    deque.push_back(value);
}
