//! `corpuscle`: every command; the window is a program of its own, which `corpuscle view` starts.

use std::process::ExitCode;

fn main() -> ExitCode {
    corpuscle_cli::run_command_line(corpuscle_cli::start_window_program)
}
