//! Output times of a run.

/// Times at multiples of a period, and the end of the run.
///
/// Each time is computed as `k * period`, so that they do not drift, however long the run and wherever it resumes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Schedule {
    period: f64,
    until: f64,
}

impl Schedule {
    /// Every `period` s up to `until` s.
    pub fn new(period: f64, until: f64) -> Self {
        Self { period, until }
    }

    /// The first time after `time`; none at the end.
    pub fn after(&self, time: f64) -> Option<f64> {
        if time >= self.until {
            return None;
        }
        let mut count = (time / self.period).floor().max(0.0);
        // Division may round down across a multiple.
        while count * self.period <= time {
            count += 1.0;
        }
        let next = count * self.period;
        let is_last = next > self.until * (1.0 - 1e-9);
        Some(if is_last { self.until } else { next })
    }
}

#[cfg(test)]
mod tests {
    use super::Schedule;
    use proptest::prelude::*;

    fn times(period: f64, until: f64) -> Vec<f64> {
        let schedule = Schedule::new(period, until);
        std::iter::successors(schedule.after(0.0), |time| schedule.after(*time)).collect()
    }

    #[test]
    fn multiples_of_the_period_and_the_end() {
        assert_eq!(times(2.0, 5.0), [2.0, 4.0, 5.0]);
        assert_eq!(times(9.0, 5.0), [5.0]);
        let tenths = times(0.1, 1.0);
        assert_eq!(tenths.len(), 10);
        assert_eq!(tenths[2], 3.0 * 0.1);
        assert_eq!(tenths[9], 1.0);
    }

    proptest! {
        #[test]
        fn times_rise_to_the_end_and_do_not_depend_on_where_one_starts(
            period in 1e-3..10.0f64, until in 1e-2..50.0f64, part in 0.0..1.0f64,
        ) {
            prop_assume!(until / period < 2000.0);
            let all = times(period, until);
            prop_assert!(all.windows(2).all(|pair| pair[0] < pair[1]));
            prop_assert_eq!(*all.last().unwrap(), until);
            let start = part * until;
            let next = Schedule::new(period, until).after(start);
            prop_assert_eq!(next, all.iter().copied().find(|time| *time > start));
        }
    }
}
