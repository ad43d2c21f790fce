use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::workers::lower_priority;

/// Asked by the work every now and then with its finished fraction, 0..1: whether to go on.
pub(super) type Progress<'a> = dyn Fn(f32) -> ControlFlow<()> + Sync + 'a;

/// One long piece of work on a thread of its own, which nobody ever waits for: it can be held,
/// goes on where it was, and stops by itself soon after this is dropped.
#[derive(Debug)]
pub(super) struct Background<T> {
    desk: Arc<Desk<T>>,
}

/// How the work ended.
#[derive(Debug, PartialEq)]
pub(super) enum Outcome<T> {
    /// With this, after so much time that it was not held.
    Done(T, Duration),
    /// Without a value, by a panic, or for want of a thread.
    Failed,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    Work,
    Hold,
    Stop,
}

/// Where the owner and the thread meet.
#[derive(Debug)]
struct Desk<T> {
    order: Mutex<Order>,
    changed: Condvar,
    /// Bits of an `f32` of at least 0: they have the order of the numbers.
    fraction: AtomicU32,
    held: Mutex<Duration>,
    is_over: AtomicBool,
    outcome: Mutex<Option<Outcome<T>>>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl<T: Send + 'static> Background<T> {
    /// Starts `work` in a pool of one thread, which stands in for all threads that it asks for.
    /// `None` from it counts as a failure, unless it was told to stop.
    pub(super) fn start(
        name: &'static str,
        at_low_priority: bool,
        work: impl FnOnce(&Progress<'_>) -> Option<T> + Send + 'static,
    ) -> Self {
        let desk = Arc::new(Desk {
            order: Mutex::new(Order::Work),
            changed: Condvar::new(),
            fraction: AtomicU32::new(0),
            held: Mutex::default(),
            is_over: AtomicBool::new(false),
            outcome: Mutex::default(),
        });
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(1)
            .thread_name(move |_| name.to_owned())
            .start_handler(move |_| {
                if at_low_priority {
                    lower_priority();
                }
            })
            .build();
        match pool {
            Ok(pool) => {
                let desk = Arc::clone(&desk);
                // The thread outlives its pool until the work is over.
                pool.spawn(move || desk.run(work));
            }
            Err(_) => desk.end(Outcome::Failed),
        }
        Self { desk }
    }
}

impl<T> Background<T> {
    /// Lets the work rest from its next question on, without using the processor.
    pub(super) fn hold(&self) {
        self.desk.tell(Order::Hold);
    }

    /// Goes on after [`Self::hold`].
    pub(super) fn go_on(&self) {
        self.desk.tell(Order::Work);
    }

    /// The finished fraction, 0..1.
    pub(super) fn fraction(&self) -> f32 {
        f32::from_bits(self.desk.fraction.load(Ordering::Relaxed))
    }

    /// True when there is an outcome.
    pub(super) fn is_over(&self) -> bool {
        self.desk.is_over.load(Ordering::Acquire)
    }

    /// How the work ended; `None` before that, and after it was taken.
    pub(super) fn take_outcome(&self) -> Option<Outcome<T>> {
        lock(&self.desk.outcome).take()
    }
}

impl<T> Drop for Background<T> {
    fn drop(&mut self) {
        self.desk.tell(Order::Stop);
    }
}

impl<T> Desk<T> {
    fn tell(&self, order: Order) {
        *lock(&self.order) = order;
        self.changed.notify_all();
    }
}

impl<T: Send> Desk<T> {
    fn run(&self, work: impl FnOnce(&Progress<'_>) -> Option<T>) {
        let started = Instant::now();
        // The work owns what a panic leaves half done; the panic was shown when it happened.
        let value = catch_unwind(AssertUnwindSafe(|| work(&|fraction| self.answer(fraction))));
        self.end(match value {
            Ok(Some(value)) => {
                let held = *lock(&self.held);
                Outcome::Done(value, started.elapsed().saturating_sub(held))
            }
            Ok(None) | Err(_) => Outcome::Failed,
        });
    }

    fn end(&self, outcome: Outcome<T>) {
        *lock(&self.outcome) = Some(outcome);
        self.is_over.store(true, Ordering::Release);
    }

    /// What [`Progress`] says; returns only when the work is not held.
    fn answer(&self, fraction: f32) -> ControlFlow<()> {
        let bits = fraction.clamp(0.0, 1.0).to_bits();
        self.fraction.fetch_max(bits, Ordering::Relaxed);
        let mut order = lock(&self.order);
        if *order == Order::Hold {
            let since = Instant::now();
            while *order == Order::Hold {
                order = self
                    .changed
                    .wait(order)
                    .unwrap_or_else(PoisonError::into_inner);
            }
            *lock(&self.held) += since.elapsed();
        }
        match *order {
            Order::Stop => ControlFlow::Break(()),
            Order::Work | Order::Hold => ControlFlow::Continue(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Receiver, channel};

    use super::*;

    const PATIENCE: Duration = Duration::from_secs(60);

    /// Asks `questions` times, sends what it was told each time, and gives 7 unless it was stopped.
    fn inquisitive(questions: u32) -> (Background<u32>, Receiver<bool>) {
        let (told, answers) = channel();
        let background = Background::start("test", false, move |progress| {
            for i in 0..questions {
                let goes_on = progress(i as f32 / questions as f32).is_continue();
                // The test may have seen enough.
                let _ = told.send(goes_on);
                if !goes_on {
                    return None;
                }
            }
            Some(7)
        });
        (background, answers)
    }

    fn outcome_of<T>(background: &Background<T>) -> Outcome<T> {
        let started = Instant::now();
        while !background.is_over() {
            assert!(started.elapsed() < PATIENCE, "it never ends");
            std::thread::sleep(Duration::from_millis(1));
        }
        background.take_outcome().expect("it is over")
    }

    #[test]
    fn the_value_arrives_once() {
        let (background, _) = inquisitive(10);
        assert!(matches!(outcome_of(&background), Outcome::Done(7, _)));
        assert!(background.take_outcome().is_none());
        assert!((background.fraction() - 0.9).abs() < 1e-6);
    }

    #[test]
    fn a_panic_is_an_outcome() {
        let background = Background::<u32>::start("test", true, |_| panic!("on purpose"));
        assert_eq!(outcome_of(&background), Outcome::Failed);
        let empty = Background::<u32>::start("test", true, |_| None);
        assert_eq!(outcome_of(&empty), Outcome::Failed);
    }

    #[test]
    fn held_work_rests_and_loses_nothing() {
        let (begun, has_begun) = channel();
        let (go, may_go) = channel();
        let background = Background::start("test", false, move |progress| {
            begun.send(()).expect("the test listens");
            may_go.recv().expect("the test speaks");
            progress(0.5).is_continue().then_some(3)
        });
        has_begun.recv_timeout(PATIENCE).expect("it starts");
        background.hold();
        go.send(()).expect("the work listens");
        // The fraction is noted before the work comes to rest.
        let started = Instant::now();
        while background.fraction() == 0.0 {
            assert!(started.elapsed() < PATIENCE, "it never asks");
            std::thread::yield_now();
        }
        assert!(!background.is_over());
        background.go_on();
        assert!(matches!(outcome_of(&background), Outcome::Done(3, _)));
    }

    #[test]
    fn dropped_work_stops_even_when_it_is_held() {
        for is_held in [false, true] {
            let (background, answers) = inquisitive(u32::MAX);
            assert_eq!(answers.recv_timeout(PATIENCE), Ok(true));
            if is_held {
                background.hold();
            }
            drop(background);
            let last = answers.iter().last();
            assert_eq!(last, Some(false));
        }
    }
}
