//! `corpuscle-window`: the command line with the window in it. `corpuscle view` starts this program.

use std::process::ExitCode;

fn main() -> ExitCode {
    corpuscle_cli::run_command_line(corpuscle_window::view)
}
