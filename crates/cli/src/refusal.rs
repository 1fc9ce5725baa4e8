//! Errors that are the input's fault.

use std::fmt;

/// Something asked for that cannot be done: exit status 2.
#[derive(Debug)]
struct Refusal(String);

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Refusal {}

/// An error that says what was asked for cannot be done.
pub fn refuse(what: impl Into<String>) -> anyhow::Error {
    Refusal(what.into()).into()
}

/// True where the input is at fault.
pub fn is_refusal(error: &anyhow::Error) -> bool {
    error.is::<Refusal>() || error.downcast_ref::<corpuscle::Error>().is_some_and(corpuscle::Error::is_refusal)
}

/// The error with its causes as one paragraph; a cause that its effect tells already is not told twice.
pub fn in_words(error: &anyhow::Error) -> String {
    error.chain().map(ToString::to_string).fold(String::new(), |told, cause| match told.as_str() {
        "" => cause,
        so_far if so_far.contains(&cause) => told,
        so_far => format!("{so_far}: {cause}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::Context;

    #[test]
    fn causes_are_told_once() {
        let error = Err::<(), _>(std::io::Error::other("disk is full"));
        let error = error.context("cannot write a.csv: disk is full").context("the run ended").unwrap_err();
        assert_eq!(in_words(&error), "the run ended: cannot write a.csv: disk is full");
    }
}
