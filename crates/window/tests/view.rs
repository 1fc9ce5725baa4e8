//! `corpuscle view`: the window of the system starts, plays, and closes; without a display it says so.

use std::process::Command;

const PROGRAM: &str = env!("CARGO_BIN_EXE_corpuscle-window");

#[test]
fn without_a_display_there_is_one_line_and_status_1() {
    let mut command = Command::new(PROGRAM);
    let output = command.args(["view", "gas/maxwell"]).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    let output = output.env_remove("WAYLAND_SOCKET").output().unwrap();
    // Other systems always have a display.
    if cfg!(target_os = "linux") {
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{told}");
        assert!(told.starts_with("error: no window can be opened") && told.lines().count() == 1, "{told}");
        assert!(told.contains("no display was found") && told.contains("WAYLAND_DISPLAY"), "{told}");
        // Neither words of the toolkit nor places on the machine where it was built.
        for foreign in [".rs", "os error", "winit", "cargo", "WAYLAND_SOCKET"] {
            assert!(!told.contains(foreign), "{foreign}: {told}");
        }
    }
}

#[test]
fn what_cannot_be_shown_is_refused_before_there_is_a_window() {
    for wrong in ["gas/maxvell", "crates"] {
        let output = Command::new(PROGRAM).args(["view", wrong]).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let output = Command::new(PROGRAM).args(["view", "gas/maxwell", "--set", "gas.restitution=7"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn under_a_virtual_display_the_window_plays_a_scene() {
    let required = std::env::var_os("CORPUSCLE_REQUIRE_GPU").is_some_and(|value| value == "1");
    let screen = ["-a", "-s", "-screen 0 1400x900x24", PROGRAM, "view", "gas/maxwell", "--measure", "1"];
    let output = match Command::new("xvfb-run").args(screen).output() {
        Ok(output) => output,
        Err(error) if !required => {
            return eprintln!("skipped the window under a virtual display: no xvfb-run ({error})");
        }
        Err(error) => panic!("the window's test needs xvfb-run: {error}"),
    };
    let told = String::from_utf8_lossy(&output.stdout);
    if !output.status.success() && !required {
        return eprintln!("skipped the window under a virtual display: {}", String::from_utf8_lossy(&output.stderr));
    }
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(told.contains("pictures/s") && told.contains("800 particles"), "{told}");
}
