use super::SmoothingKernel;
use crate::{Lanes, LanesExt, Simd};
use std::f64::consts::PI;

/// The three kernels of Müller, Charypar & Gross 2003, each for what it does best. Support h.
///
/// - Density: poly6, (h^2 - r^2)^3 times 4/(pi h^8) in the plane, 315/(64 pi h^9) in space. It is flat at the centre.
/// - Pressure: spiky (Desbrun & Gascuel 1996), (h - r)^3 times 10/(pi h^5), 15/(pi h^6). Its slope does not vanish at the centre, so it
///   keeps close particles apart.
/// - Diffusion: the viscosity kernel, whose Laplacian is (h - r) times 40/(pi h^5), 45/(pi h^6): positive everywhere, so diffusion never
///   runs backwards.
#[derive(Debug, Clone, Copy)]
pub struct Mueller<const D: usize> {
    h: f64,
    h_squared: f64,
    /// Of (h^2 - r^2)^3.
    of_value: f64,
    /// Of (h - r)^2.
    of_slope: f64,
    /// Of h - r.
    of_laplacian: f64,
}

impl<const D: usize> Mueller<D> {
    /// Kernels of support `h`, m.
    #[inline(always)]
    pub fn new(h: f64) -> Self {
        const { assert!(D == 2 || D == 3) };
        let h_squared = h * h;
        let [of_value, of_slope, of_laplacian] = if D == 2 {
            let h_5 = PI * h * h * h * h * h;
            [4.0 / (PI * h_squared * h_squared * h_squared * h_squared), 30.0 / h_5, 40.0 / h_5]
        } else {
            let of_both = 45.0 / (PI * h.powi(6));
            [315.0 / (64.0 * PI * h.powi(9)), of_both, of_both]
        };
        Self { h, h_squared, of_value, of_slope, of_laplacian }
    }
}

impl<const D: usize> SmoothingKernel<D> for Mueller<D> {
    #[inline(always)]
    fn support(&self) -> f64 {
        self.h
    }

    #[inline(always)]
    fn value(&self, r_squared: f64) -> f64 {
        let inside = (self.h_squared - r_squared).max(0.0);
        self.of_value * inside * inside * inside
    }

    #[inline(always)]
    fn fall_over_r(&self, r_squared: f64) -> f64 {
        let inside = (self.h_squared - r_squared).max(0.0);
        6.0 * self.of_value * inside * inside
    }

    #[inline(always)]
    fn slope(&self, r: f64) -> f64 {
        let inside = (self.h - r).max(0.0);
        self.of_slope * inside * inside
    }

    #[inline(always)]
    fn laplacian(&self, r: f64) -> f64 {
        self.of_laplacian * (self.h - r).max(0.0)
    }

    // Shapes and factors are rounded in the plane and in space as they always were, so that runs give the same bits.
    #[inline(always)]
    fn value_shape<S: Simd>(&self, r_squared: Lanes<S>) -> Lanes<S> {
        let inside =
            if D == 2 { 1.0 - r_squared * (1.0 / self.h_squared) } else { self.h_squared - r_squared }.positive();
        inside * inside * inside
    }

    #[inline(always)]
    fn value_factor(&self) -> f64 {
        if D == 2 { self.value(0.0) } else { self.of_value }
    }

    #[inline(always)]
    fn slope_shape<S: Simd>(&self, r: Lanes<S>) -> Lanes<S> {
        let inside = (self.h - r).positive();
        inside * inside
    }

    #[inline(always)]
    fn times_slope_shape<S: Simd>(&self, amount: Lanes<S>, r: Lanes<S>) -> Lanes<S> {
        let inside = (self.h - r).positive();
        amount * inside * inside
    }

    #[inline(always)]
    fn slope_factor(&self) -> f64 {
        if D == 2 { self.slope(0.0) / (self.h * self.h) } else { self.of_slope }
    }

    #[inline(always)]
    fn laplacian_shape<S: Simd>(&self, r: Lanes<S>) -> Lanes<S> {
        (self.h - r).positive()
    }

    #[inline(always)]
    fn laplacian_factor(&self) -> f64 {
        if D == 2 { self.laplacian(0.0) / self.h } else { self.of_laplacian }
    }

    fn wgsl(&self) -> &'static str {
        include_str!("mueller.wgsl")
    }
}
