//! `corpuscle view` starts the program with the window, and says so where it is missing.

mod tool;

use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, MutexGuard, PoisonError};
use tool::{Ended, Place};

/// One test at a time: a process that another test starts while this one writes its copy of the program would hold that copy open, and what is open
/// for writing cannot be started ("Text file busy").
fn alone() -> MutexGuard<'static, ()> {
    static LOCK: Mutex<()> = Mutex::new(());
    LOCK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A copy of the program in the folder of a test, as if installed there.
fn installed(place: &Place) -> PathBuf {
    let program = place.path(format!("corpuscle{}", std::env::consts::EXE_SUFFIX));
    fs::copy(env!("CARGO_BIN_EXE_corpuscle"), &program).unwrap();
    program
}

fn view(program: &PathBuf, arguments: &[&str]) -> Ended {
    let mut command = Command::new(program);
    command.arg("view").args(arguments).env_remove("CARGO").env_remove("CARGO_MANIFEST_DIR");
    Ended::of(command.output().unwrap())
}

#[test]
fn without_the_window_program_its_installation_is_told() {
    let _alone = alone();
    let place = Place::new();
    let ended = view(&installed(&place), &[]).expect_status(2);
    assert!(ended.stderr.contains("corpuscle-window") && ended.stderr.contains("cargo install"), "{}", ended.stderr);
    assert_eq!(ended.stderr.lines().count(), 1, "{}", ended.stderr);
}

#[cfg(unix)]
#[test]
fn the_window_program_gets_every_argument_and_its_status_is_returned() {
    use std::os::unix::fs::PermissionsExt;
    let _alone = alone();
    let place = Place::new();
    let program = installed(&place);
    place.write("corpuscle-window", "#!/bin/sh\nprintf '%s|' \"$@\"\nexit 7\n");
    fs::set_permissions(place.path("corpuscle-window"), fs::Permissions::from_mode(0o755)).unwrap();
    let ended = view(&program, &["gas/maxwell", "--set", "gas.restitution=0.5 "]).expect_status(7);
    assert_eq!(ended.stdout, "view|gas/maxwell|--set|gas.restitution=0.5 |");
}
