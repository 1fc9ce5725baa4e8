//! Named scalars over time.

/// One column of the gauge table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GaugeColumn {
    /// The gauge: `P1`, or the model's name for a total.
    pub gauge: String,
    /// What it measures, in words joined by `_`: `depth`.
    pub quantity: &'static str,
    /// Unit as in a file's header: `m`, `m_per_s`, `m3_per_s`; empty in reduced units.
    pub unit: &'static str,
}

impl GaugeColumn {
    /// The column's header in files: `P1.depth_m`, or `gas.pressure` without a unit.
    pub fn header(&self) -> String {
        let Self { gauge, quantity, unit } = self;
        if unit.is_empty() { format!("{gauge}.{quantity}") } else { format!("{gauge}.{quantity}_{unit}") }
    }
}

#[cfg(test)]
mod tests {
    use super::GaugeColumn;

    #[test]
    fn header_names_gauge_quantity_and_unit() {
        let depth = GaugeColumn { gauge: "P1".into(), quantity: "depth", unit: "m" };
        assert_eq!(depth.header(), "P1.depth_m");
        let pressure = GaugeColumn { gauge: "gas".into(), quantity: "pressure", unit: "" };
        assert_eq!(pressure.header(), "gas.pressure");
    }
}
