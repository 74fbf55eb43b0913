//! Blocks of devices that lie in one array, for emitted Rust. It asks whether they exist before; where one does not,
//! nothing happens.

use core::ops::Range;

/// The positions of `count` elements from `first` on, if a slice has them all.
fn range(first: i32, count: i32, length: usize) -> Option<Range<usize>> {
    let first = usize::try_from(first).ok()?;
    let end = first.checked_add(usize::try_from(count).ok()?)?;
    (end <= length).then_some(first..end)
}

/// Copies `count` elements of an array to others in it, as if all were read before one is written.
pub fn copy_within<T: Copy>(array: &mut [T], from: i32, to: i32, count: i32) {
    let length = array.len();
    if let (Some(source), Some(target)) = (range(from, count, length), range(to, count, length)) {
        array.copy_within(source, target.start);
    }
}

/// Copies `count` elements of an array, from `from` on, to those of another one from `to` on.
pub fn copy<T: Copy>(source: &[T], from: i32, target: &mut [T], to: i32, count: i32) {
    let source = range(from, count, source.len()).and_then(|run| source.get(run));
    let target = range(to, count, target.len()).and_then(|run| target.get_mut(run));
    if let (Some(source), Some(target)) = (source, target) {
        target.copy_from_slice(source);
    }
}

/// Sets `count` elements of an array from `to` on.
pub fn fill<T: Copy>(array: &mut [T], to: i32, count: i32, value: T) {
    let run = range(to, count, array.len());
    if let Some(run) = run.and_then(|run| array.get_mut(run)) {
        run.fill(value);
    }
}

#[cfg(test)]
mod tests {
    use super::{copy, copy_within, fill};

    #[test]
    fn overlapping_blocks_are_copied_as_they_were() {
        let mut words = [1, 2, 3, 4, 5];
        copy_within(&mut words, 0, 1, 4);
        assert_eq!(words, [1, 1, 2, 3, 4]);
        copy_within(&mut words, 1, 0, 4);
        assert_eq!(words, [1, 2, 3, 4, 4]);
    }

    #[test]
    fn a_block_that_leaves_its_array_stays_as_it_is() {
        let mut words = [1, 2, 3];
        for (from, to, count) in [
            (-1, 0, 2),
            (0, 2, 2),
            (2, 0, 2),
            (0, 0, -1),
            (0, i32::MAX, 1),
        ] {
            copy_within(&mut words, from, to, count);
            copy(&[7; 3], from, &mut words, to, count);
        }
        for (to, count) in [(-1, 2), (2, 2), (0, -1), (i32::MAX, i32::MAX)] {
            fill(&mut words, to, count, 9);
        }
        assert_eq!(words, [1, 2, 3]);
        copy(&[7; 3], 1, &mut words, 0, 2);
        fill(&mut words, 2, 1, 9);
        assert_eq!(words, [7, 7, 9]);
    }
}
