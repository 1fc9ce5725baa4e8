//! Every reader takes its valid inputs, refuses those that were found, and stands some hundred changed ones.

use corpuscle_fuzz::drive::{Until, call, fuzz, scratch};
use corpuscle_fuzz::{Target, corpus, targets};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The memory of a call is that of the whole process: one test at a time.
fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Inputs that made a reader fail once: it panicked, went on for ever or took too much memory.
#[test]
fn inputs_that_were_found_are_read_or_refused() {
    let _alone = alone();
    let mut count = 0;
    for target in targets() {
        for (name, input) in corpus::found(&target) {
            let result = call(&target, &input);
            assert!(result.is_ok(), "{} {name}: {result:?}", target.name);
            count += 1;
        }
    }
    assert!(count >= 8, "{count}");
}

#[test]
fn every_target_has_valid_inputs_that_are_read() {
    let _alone = alone();
    for target in targets() {
        let inputs = corpus::of(&target);
        let read = |(_, input): &&(String, Vec<u8>)| call(&target, input).is_ok_and(|(answer, _)| answer.is_ok());
        let count = inputs.iter().filter(read).count();
        assert!(count > 0, "{} reads none of its {} inputs", target.name, inputs.len());
    }
}

#[test]
fn every_reader_stands_changed_inputs() {
    let _alone = alone();
    let folder = scratch().unwrap();
    for target in targets() {
        let until = Until { time: Duration::from_secs(1), executions: 500 };
        let outcome = fuzz(&target, 7, until, &folder.path().join("current"), true).unwrap();
        assert!(outcome.executions > 0);
        let kinds: Vec<_> = outcome.failures.keys().collect();
        assert!(kinds.is_empty(), "{}: {kinds:?}", target.name);
    }
}

/// The driver notices what it is there for.
#[test]
fn a_panic_and_too_much_memory_are_noticed_and_their_inputs_shortened() {
    let _alone = alone();
    fn fails(bytes: &[u8]) -> Result<String, String> {
        assert!(!bytes.contains(&b'7'), "a seven");
        if bytes.starts_with(b"22") {
            drop(std::hint::black_box(Vec::<u8>::with_capacity(5 << 30)));
        }
        Err("no".into())
    }
    let more = || vec![b"123456".to_vec(), b"2345 2345".to_vec()];
    let target = Target { name: "none", about: "", corpus: "none", read: fails, more };
    let folder = scratch().unwrap();
    let until = Until { time: Duration::from_secs(20), executions: 200_000 };
    let outcome = fuzz(&target, 1, until, &folder.path().join("current"), true).unwrap();
    let seven = outcome.failures.iter().find(|(kind, _)| kind.contains("a seven")).unwrap();
    assert_eq!(seven.1, b"7");
    assert_eq!(outcome.failures["too much memory"], b"22");
}
