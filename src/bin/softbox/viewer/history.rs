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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_movement_is_one_step_once_it_rests() {
        let mut history = History::new(0);
        for (value, now) in [(1, 0.1), (2, 0.2), (3, 0.3)] {
            history.observe(value, now, true);
        }
        history.observe(3, 1.0, false);
        history.observe(4, 2.0, false);
        history.observe(4, 3.0, false);
        assert_eq!(history.undo(4), 3);
        assert_eq!(history.undo(3), 0);
        assert_eq!(history.undo(0), 0);
        assert_eq!(history.redo(0), 3);
        assert_eq!(history.redo(3), 4);
        assert_eq!(history.redo(4), 4);
    }

    #[test]
    fn undo_in_the_middle_of_a_movement_goes_back_to_its_start() {
        let mut history = History::new(0);
        history.observe(7, 0.1, true);
        assert_eq!(history.undo(7), 0);
        assert_eq!(history.redo(0), 7);
    }

    #[test]
    fn a_new_movement_forgets_what_was_undone() {
        let mut history = History::new(0);
        assert_eq!(history.undo(1), 0);
        history.observe(5, 10.0, false);
        history.observe(5, 11.0, false);
        assert_eq!(history.redo(5), 5);
        assert_eq!(history.undo(5), 0);
    }
}
