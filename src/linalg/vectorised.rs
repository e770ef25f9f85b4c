//! Loops for the vector registers of the machine that runs them.

/// Defines a function whose body is compiled for every kind of vector registers; in it `$simd` are those of the machine.
macro_rules! vectorised {
    (
        $(#[$meta:meta])*
        fn $name:ident<$life:lifetime, $S:ident>($simd:ident, $($arg:ident: $type:ty),* $(,)?) $(-> $out:ty)? $body:block
    ) => {
        $(#[$meta])*
        pub(crate) fn $name<$life>($($arg: $type),*) $(-> $out)? {
            struct Kernel<$life> {
                $($arg: $type),*
            }
            impl<$life> pulp::WithSimd for Kernel<$life> {
                type Output = $crate::linalg::vectorised::vectorised!(@output $($out)?);

                #[inline(always)]
                fn with_simd<$S: pulp::Simd>(self, $simd: $S) -> Self::Output {
                    let Kernel { $($arg),* } = self;
                    $body
                }
            }
            pulp::Arch::new().dispatch(Kernel { $($arg),* })
        }
    };
    (@output) => { () };
    (@output $out:ty) => { $out };
}
pub(crate) use vectorised;

vectorised! {
    /// Scalar product.
    fn dot<'a, S>(simd, a: &'a [f64], b: &'a [f64]) -> f64 {
        let ((a, a_rest), (b, b_rest)) = (S::as_simd_f64s(a), S::as_simd_f64s(b));
        let mut sums = [simd.splat_f64s(0.0); 4];
        let (a_fours, a_few) = a.as_chunks::<4>();
        let (b_fours, b_few) = b.as_chunks::<4>();
        for (a, b) in a_fours.iter().zip(b_fours) {
            for l in 0..4 {
                sums[l] = simd.add_f64s(sums[l], simd.mul_f64s(a[l], b[l]));
            }
        }
        for (&a, &b) in a_few.iter().zip(b_few) {
            sums[0] = simd.add_f64s(sums[0], simd.mul_f64s(a, b));
        }
        let sum = simd.add_f64s(simd.add_f64s(sums[0], sums[1]), simd.add_f64s(sums[2], sums[3]));
        simd.reduce_sum_f64s(sum) + a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum::<f64>()
    }
}
