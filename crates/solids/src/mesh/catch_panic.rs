//! Panics of a library that become errors here, without the message that a panic prints.

use std::cell::Cell;
use std::panic::{UnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// The result of `read`; none where it panics. Panics elsewhere, and of other threads, are reported as usual.
pub(super) fn caught<T>(read: impl FnOnce() -> T + UnwindSafe) -> Option<T> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = take_hook();
        set_hook(Box::new(move |panic| {
            if !QUIET.get() {
                before(panic);
            }
        }));
    });
    QUIET.set(true);
    let result = catch_unwind(read);
    QUIET.set(false);
    result.ok()
}

#[cfg(test)]
mod tests {
    use super::caught;

    #[test]
    fn a_panic_is_nothing_and_the_rest_goes_through() {
        assert_eq!(caught(|| 3), Some(3));
        assert_eq!(caught(|| [1, 2][std::hint::black_box(5)]), None);
    }
}
