//! Undo and redo for a value that is changed continuously.

/// Seconds of rest after which a change counts as finished.
const REST: f64 = 0.4;
/// The most steps that are kept.
const LIMIT: usize = 200;

/// The values before and after the present one.
#[derive(Debug)]
pub(super) struct History<T> {
    past: Vec<T>,
    future: Vec<T>,
    settled: T,
    seen: T,
    changed_at: f64,
}

impl<T: Copy + PartialEq> History<T> {
    /// No past, `present` as the value at rest.
    pub(super) fn new(present: T) -> Self {
        Self {
            past: Vec::new(),
            future: Vec::new(),
            settled: present,
            seen: present,
            changed_at: 0.0,
        }
    }

    /// Notes the value at the time `now` in seconds. A movement that has come to rest becomes one
    /// step.
    pub(super) fn observe(&mut self, value: T, now: f64, is_moving: bool) {
        if value != self.seen {
            self.seen = value;
            self.changed_at = now;
        }
        if !is_moving && now - self.changed_at >= REST {
            self.settle(value);
        }
    }

    /// The value before `present`, or `present` when there is none.
    pub(super) fn undo(&mut self, present: T) -> T {
        self.settle(present);
        self.travel(present, true)
    }

    /// The value that was undone last, or `present` when there is none.
    pub(super) fn redo(&mut self, present: T) -> T {
        self.settle(present);
        self.travel(present, false)
    }

    fn settle(&mut self, value: T) {
        if value == self.settled {
            return;
        }
        self.past.push(self.settled);
        if self.past.len() > LIMIT {
            self.past.remove(0);
        }
        self.future.clear();
        self.settled = value;
        self.seen = value;
    }

    fn travel(&mut self, present: T, is_back: bool) -> T {
        let (from, to) = if is_back {
            (&mut self.past, &mut self.future)
        } else {
            (&mut self.future, &mut self.past)
        };
        let Some(value) = from.pop() else {
            return present;
        };
        to.push(present);
        self.settled = value;
        self.seen = value;
        value
    }
}
