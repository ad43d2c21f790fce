use std::ops::AddAssign;
use std::time::{Duration, Instant};

use rustix::time::{ClockId, clock_gettime};

/// Seconds that something took.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Taken {
    /// By the clock on the wall.
    pub(crate) wall: f64,
    /// Of processors, which other programs on the machine disturb less.
    pub(crate) processor: f64,
}

impl AddAssign for Taken {
    fn add_assign(&mut self, more: Self) {
        self.wall += more.wall;
        self.processor += more.processor;
    }
}

/// Does `work`; the processor time is that of all threads of this process.
pub(crate) fn of_process<T>(work: impl FnOnce() -> T) -> (T, Taken) {
    timed(ClockId::ProcessCPUTime, work)
}

/// Does `work`; the processor time is that of this thread.
pub(crate) fn of_thread<T>(work: impl FnOnce() -> T) -> (T, Taken) {
    timed(ClockId::ThreadCPUTime, work)
}

fn timed<T>(clock: ClockId, work: impl FnOnce() -> T) -> (T, Taken) {
    let (start, busy) = (Instant::now(), now(clock));
    let result = work();
    let taken = Taken {
        processor: (now(clock) - busy).as_secs_f64(),
        wall: start.elapsed().as_secs_f64(),
    };
    (result, taken)
}

fn now(clock: ClockId) -> Duration {
    let time = clock_gettime(clock);
    let seconds = u64::try_from(time.tv_sec).expect("time is positive");
    Duration::from_secs(seconds) + Duration::from_nanos(time.tv_nsec.unsigned_abs())
}
