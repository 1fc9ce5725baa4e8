//! Whether a scene fits into the memory that a program can have, told before any of it is taken.

use corpuscle_model::ModelError;

/// The part of the addresses of a program that a scene may fill: with 32 bits, as in a page of a browser, 3 of 4 GB.
const PART: f64 = 0.75;

/// Refuses a scene that needs more memory, bytes, than there are addresses for; `remedy` says how it needs less.
///
/// # Errors
/// [`ModelError::Setup`].
pub(crate) fn refuse_what_does_not_fit(bytes: f64, remedy: &str) -> Result<(), ModelError> {
    within(bytes, PART * usize::MAX as f64, remedy)
}

fn within(bytes: f64, most: f64, remedy: &str) -> Result<(), ModelError> {
    if bytes <= most {
        return Ok(());
    }
    let [needed, most] = [bytes, most].map(|bytes| bytes / 1e9);
    let text = format!(
        "the scene needs about {needed:.1} GB of memory, and {most:.1} GB can be had here: {remedy}, or run it with the program, which is not \
         bound by a page's memory"
    );
    Err(ModelError::Setup(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_large_is_refused_with_what_to_do() {
        assert!(within(3.0e9, 3.2e9, "").is_ok());
        let ModelError::Setup(text) = within(1e10, 3.2e9, "give fewer balls").unwrap_err() else { panic!() };
        assert!(text.contains("10.0 GB") && text.contains("3.2 GB") && text.contains("give fewer balls"), "{text}");
        // Here there are more addresses than memory.
        assert!(refuse_what_does_not_fit(1e12, "").is_ok());
    }
}
