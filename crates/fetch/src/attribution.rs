//! Attribution of the data.

/// The text that must accompany results made from this terrain (licence of the Copernicus
/// WorldDEM-30, Article 5).
pub const ATTRIBUTION: &str = "The terrain is produced using Copernicus WorldDEM-30 © DLR e.V. 2010-2014 and © Airbus \
                               Defence and Space GmbH 2014-2018 provided under COPERNICUS by the European Union and ESA; \
                               all rights reserved.";
