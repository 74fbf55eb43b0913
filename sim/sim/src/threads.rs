//! Threads of a command: their number, and work divided among them.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::{env, thread};

/// Environment variable with the number of threads. Default: one per processor.
pub const VARIABLE: &str = "RUNGC_THREADS";

/// Largest number of threads.
const MOST: usize = 256;

/// Stack of a thread in bytes, as large as that of the first one usually is.
const STACK: usize = 8 << 20;

/// Number of threads, at least 1. Results never depend on it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Threads(NonZeroUsize);

impl Threads {
    /// The calling thread alone.
    pub const ONE: Threads = Threads(NonZeroUsize::MIN);

    /// This many threads; 0 is 1.
    pub fn new(count: usize) -> Self {
        Threads(NonZeroUsize::new(count.min(MOST)).unwrap_or(NonZeroUsize::MIN))
    }

    /// The number that [`VARIABLE`] states, if any.
    ///
    /// # Errors
    /// It is not a number from 1 to 256.
    pub fn stated() -> Result<Option<Self>, String> {
        let Some(stated) = env::var_os(VARIABLE).filter(|stated| !stated.is_empty()) else {
            return Ok(None);
        };
        let number = stated.to_str().and_then(|text| text.parse().ok());
        match number.filter(|number| (1..=MOST).contains(number)) {
            Some(number) => Ok(Some(Threads::new(number))),
            None => Err(format!(
                "{VARIABLE}: `{}` is not a number from 1 to {MOST}",
                stated.display()
            )),
        }
    }

    /// The number that [`VARIABLE`] states, else one per processor.
    pub fn usual() -> Self {
        let stated = Threads::stated().ok().flatten();
        stated.unwrap_or_else(|| {
            Threads::new(thread::available_parallelism().map_or(1, NonZeroUsize::get))
        })
    }

    /// The number.
    pub const fn count(self) -> usize {
        self.0.get()
    }

    /// The results of `work` on all items, in their order.
    pub fn map<T: Sync, R: Send>(self, items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
        let mut results = Vec::with_capacity(items.len());
        self.each(
            items,
            || (),
            |(), item| work(item),
            |result| {
                results.push(result);
                ControlFlow::<Infallible>::Continue(())
            },
        );
        results
    }

    /// Works on items; each thread begins with a state from `start`, and takes an item after another. The calling
    /// thread passes the results to `take` in the order of the items, as soon as they are known; `take` may stop the
    /// work.
    pub fn each<T: Sync, S, R: Send, B>(
        self,
        items: &[T],
        start: impl Fn() -> S + Sync,
        work: impl Fn(&mut S, &T) -> R + Sync,
        mut take: impl FnMut(R) -> ControlFlow<B>,
    ) {
        let threads = self.count().min(items.len());
        if threads <= 1 {
            let mut state = start();
            let mut results = items.iter().map(|item| work(&mut state, item));
            let _ = results.try_for_each(take);
            return;
        }
        let next = AtomicUsize::new(0);
        let (sender, results) = mpsc::channel();
        let worker = |sender: mpsc::Sender<(usize, R)>| {
            let mut state = start();
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                let Some(item) = items.get(number) else {
                    return;
                };
                let result = work(&mut state, item);
                if sender.send((number, result)).is_err() {
                    return;
                }
            }
        };
        let worker = &worker;
        thread::scope(|scope| {
            let spawn = |_| {
                let sender = sender.clone();
                let builder = thread::Builder::new().stack_size(STACK);
                builder.spawn_scoped(scope, move || worker(sender)).ok()
            };
            let workers: Vec<_> = (0..threads).filter_map(spawn).collect();
            if workers.is_empty() {
                // A system without further threads.
                worker(sender.clone());
            }
            drop(sender);
            in_order(results, &mut take);
            next.store(items.len(), Ordering::Relaxed);
            for worker in workers {
                worker.join().unwrap_or_else(|panic| resume_unwind(panic));
            }
        });
    }
}

/// Passes results on in the order of their numbers, until there are no more or `take` breaks.
fn in_order<R, B>(results: mpsc::Receiver<(usize, R)>, take: &mut impl FnMut(R) -> ControlFlow<B>) {
    let mut early = BTreeMap::new();
    let mut expected = 0;
    for (number, result) in results {
        early.insert(number, result);
        while let Some(result) = early.remove(&expected) {
            expected += 1;
            if take(result).is_break() {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicBool;
    use std::time::Duration;

    /// The numbers of threads that the tests compare.
    const COUNTS: [usize; 4] = [1, 2, 7, 40];

    #[test]
    fn results_are_in_order() {
        let items: Vec<u64> = (0..30).collect();
        for count in COUNTS {
            // The first items take longest.
            let squares = Threads::new(count).map(&items, |&item| {
                thread::sleep(Duration::from_micros(200 * (30 - item)));
                item * item
            });
            assert!(squares.into_iter().eq(items.iter().map(|item| item * item)));
        }
    }

    #[test]
    fn work_ends_where_its_taker_stops() {
        let items: Vec<usize> = (0..1_000).collect();
        for count in COUNTS {
            let (worked, mut taken) = (AtomicUsize::new(0), Vec::new());
            let work = |states: &mut usize, &item: &usize| {
                *states += 1;
                worked.fetch_add(1, Ordering::Relaxed);
                item
            };
            Threads::new(count).each(
                &items,
                || 0,
                work,
                |item| {
                    taken.push(item);
                    match taken.len() {
                        5 => ControlFlow::Break(()),
                        _ => ControlFlow::Continue(()),
                    }
                },
            );
            assert_eq!(taken, [0, 1, 2, 3, 4]);
            // More threads may work on what follows before the end reaches them.
            assert!(count > 1 || worked.into_inner() == taken.len());
        }
    }

    #[test]
    fn a_panic_of_a_thread_is_one_of_the_caller() {
        let failed = AtomicBool::new(false);
        let caught = std::panic::catch_unwind(|| {
            Threads::new(3).map(&[1, 2, 3, 4], |&item| {
                failed.store(true, Ordering::Relaxed);
                assert!(item < 4, "on purpose");
            })
        });
        assert!(failed.into_inner() && caught.is_err());
    }
}
