//! Simple shapes, exact to the last digit: they have formulas, so nothing is interpolated.

use super::{bounds, finite, positive};
use crate::{Terrain, TerrainError};
use corpuscle_scene::{Bowl, Bump, Plane};

/// An even plane.
pub(crate) fn plane(plane: &Plane) -> Result<Terrain, TerrainError> {
    let Plane { extent, slope_east, slope_north, height_m } = plane.clone();
    let bounds = bounds("plane", &extent)?;
    finite("plane", &[("slope_east", slope_east), ("slope_north", slope_north), ("height_m", height_m)])?;
    let [x0, y0] = bounds.centre();
    Ok(Terrain::analytic(bounds, extent.cell_m, move |x, y| {
        (height_m + slope_east * (x - x0) + slope_north * (y - y0), [slope_east, slope_north])
    }))
}

/// A Gaussian bump on a flat bed.
pub(crate) fn bump(bump: &Bump) -> Result<Terrain, TerrainError> {
    let Bump { extent, height_m, width_m, at } = bump.clone();
    let bounds = bounds("bump", &extent)?;
    positive("bump", &[("width_m", width_m)])?;
    let [x0, y0] = at.unwrap_or(bounds.centre());
    finite("bump", &[("height_m", height_m), ("at[0]", x0), ("at[1]", y0)])?;
    let narrowness = 1.0 / (width_m * width_m);
    Ok(Terrain::analytic(bounds, extent.cell_m, move |x, y| {
        let [dx, dy] = [x - x0, y - y0];
        let height = height_m * (-0.5 * narrowness * (dx * dx + dy * dy)).exp();
        (height, [-height * narrowness * dx, -height * narrowness * dy])
    }))
}

/// A paraboloid of revolution (Thacker 1981).
pub(crate) fn bowl(bowl: &Bowl) -> Result<Terrain, TerrainError> {
    let Bowl { extent, depth_m, radius_m } = bowl.clone();
    let bounds = bounds("bowl", &extent)?;
    positive("bowl", &[("radius_m", radius_m)])?;
    finite("bowl", &[("depth_m", depth_m)])?;
    let [x0, y0] = bounds.centre();
    let curvature = depth_m / (radius_m * radius_m);
    Ok(Terrain::analytic(bounds, extent.cell_m, move |x, y| {
        let [dx, dy] = [x - x0, y - y0];
        (curvature * (dx * dx + dy * dy) - depth_m, [2.0 * curvature * dx, 2.0 * curvature * dy])
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_scene::Extent;

    /// Slopes agree with finite differences of the heights.
    fn assert_slopes(terrain: &Terrain) {
        let step = 1e-4;
        for [x, y] in [[3.0, 4.0], [12.0, 7.5], [8.1, 1.2]] {
            let (_, slope) = terrain.height_and_slope(x, y);
            let east = (terrain.height(x + step, y) - terrain.height(x - step, y)) / (2.0 * step);
            let north = (terrain.height(x, y + step) - terrain.height(x, y - step)) / (2.0 * step);
            assert!((slope[0] - east).abs() < 1e-7 && (slope[1] - north).abs() < 1e-7, "{slope:?} {east} {north}");
        }
    }

    fn extent() -> Extent {
        Extent { length_m: 20.0, width_m: 10.0, cell_m: 1.0 }
    }

    #[test]
    fn plane_rises_as_asked() {
        let plane = plane(&Plane { extent: extent(), slope_east: 0.1, slope_north: -0.2, height_m: 3.0 }).unwrap();
        assert_eq!(plane.height_and_slope(10.0, 5.0), (3.0, [0.1, -0.2]));
        assert!((plane.height(20.0, 0.0) - 5.0).abs() < 1e-12);
        assert_slopes(&plane);
    }

    #[test]
    fn bump_has_its_top_where_asked() {
        let shape = Bump { extent: extent(), height_m: 2.0, width_m: 3.0, at: Some([12.0, 4.0]) };
        let bump = bump(&shape).unwrap();
        assert_eq!(bump.height_and_slope(12.0, 4.0), (2.0, [0.0, 0.0]));
        assert!((bump.height(15.0, 4.0) - 2.0 * (-0.5_f64).exp()).abs() < 1e-15);
        assert_slopes(&bump);
    }

    #[test]
    fn bowl_reaches_zero_at_its_radius() {
        let bowl = bowl(&Bowl { extent: extent(), depth_m: 0.5, radius_m: 4.0 }).unwrap();
        assert_eq!(bowl.height(10.0, 5.0), -0.5);
        assert!(bowl.height(14.0, 5.0).abs() < 1e-15);
        assert_slopes(&bowl);
    }

    #[test]
    fn nonsense_is_refused_by_name() {
        let error = plane(&Plane { extent: extent(), slope_east: f64::NAN, ..Plane::default() }).unwrap_err();
        assert!(error.to_string().contains("slope_east = NaN in [terrain.plane]"), "{error}");
        let huge = Extent { length_m: 1e6, width_m: 1e6, cell_m: 1.0 };
        let error = bowl(&Bowl { extent: huge, ..Bowl::default() }).unwrap_err();
        assert!(error.to_string().contains("cell_m larger"), "{error}");
        let error = bump(&Bump { width_m: 0.0, ..Bump::default() }).unwrap_err();
        assert!(error.to_string().contains("width_m = 0"), "{error}");
    }
}
