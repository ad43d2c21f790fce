//! What the types that wrap registers of x86 have in common but for the names of the intrinsics.
//!
//! All of it is sound for the same reason: values of these types are made and used only by kernels
//! that were started after a look whether the processor has the instructions ([`super::avx2::run`],
//! [`super::avx512::run`], the traversal's own dispatch).

/// Operators of a type that wraps one register.
macro_rules! register_operators {
    ($type:ident: $($trait:ident $name:ident $intrinsic:ident;)*) => {
        $(impl std::ops::$trait for $type {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                // SAFETY: the instructions are there (see `registers`).
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        })*
    };
}
pub(super) use register_operators;

/// Operators of a type that wraps two registers.
macro_rules! pair_operators {
    ($type:ident: $($trait:ident $name:ident $intrinsic:ident;)*) => {
        $(impl std::ops::$trait for $type {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                // SAFETY: the instructions are there (see `registers`).
                unsafe { Self($intrinsic(self.0, other.0), $intrinsic(self.1, other.1)) }
            }
        })*
    };
}
pub(super) use pair_operators;

/// Methods of [`super::Lanes`] that are one intrinsic each.
macro_rules! float_methods {
    (
        ints: $ints:ident, load: $load:ident, store: $store:ident, min: $min:ident,
        max: $max:ident, sqrt: $sqrt:ident, to_ints: $to_ints:ident,
        from_ints: $from_ints:ident, of_ints: $of_ints:ident $(,)?
    ) => {
        #[inline(always)]
        fn load_row(from: &[f32; ROW]) -> Self {
            // SAFETY: the instructions are there (see `registers`); no register is longer than a row.
            Self(unsafe { $load(from.as_ptr()) })
        }

        #[inline(always)]
        fn store_row(self, to: &mut [f32; ROW]) {
            // SAFETY: the instructions are there (see `registers`); no register is longer than a row.
            unsafe { $store(to.as_mut_ptr(), self.0) }
        }

        #[inline(always)]
        fn min(self, other: Self) -> Self {
            // SAFETY: the instructions are there (see `registers`).
            Self(unsafe { $min(self.0, other.0) })
        }

        #[inline(always)]
        fn max(self, other: Self) -> Self {
            // SAFETY: the instructions are there (see `registers`).
            Self(unsafe { $max(self.0, other.0) })
        }

        #[inline(always)]
        fn sqrt(self) -> Self {
            // SAFETY: the instructions are there (see `registers`).
            Self(unsafe { $sqrt(self.0) })
        }

        #[inline(always)]
        fn to_ints(self) -> $ints {
            // SAFETY: the instructions are there (see `registers`).
            $ints(unsafe { $to_ints(self.0) })
        }

        #[inline(always)]
        fn from_ints(ints: $ints) -> Self {
            // SAFETY: the instructions are there (see `registers`).
            Self(unsafe { $from_ints(ints.0) })
        }

        #[inline(always)]
        fn of_ints(ints: $ints) -> Self {
            // SAFETY: the instructions are there (see `registers`).
            Self(unsafe { $of_ints(ints.0) })
        }
    };
}
pub(super) use float_methods;

/// The whole of [`super::IntLanes`] for a type that wraps one register.
macro_rules! int_lanes {
    (
        $type:ident: splat: $splat:ident, bytes: $bytes:ident, load: $load:ident,
        store: $store:ident, add: $add:ident, mul: $mul:ident, and: $and:ident, or: $or:ident,
        xor: $xor:ident, shl: $shl:ident, shr: $shr:ident, sar: $sar:ident,
        look_up: $look_up:ident, repeat: $repeat:ident $(,)?
    ) => {
        register_operators! {
            $type:
            Add add $add;
            Mul mul $mul;
            BitAnd bitand $and;
            BitOr bitor $or;
            BitXor bitxor $xor;
        }

        impl IntLanes for $type {
            #[inline(always)]
            fn splat(value: u32) -> Self {
                // SAFETY: the instructions are there (see `registers`).
                Self(unsafe { $splat(value.cast_signed()) })
            }

            #[inline(always)]
            fn load(from: &[u32; ROW]) -> Self {
                // SAFETY: the instructions are there (see `registers`); no register is longer than a
                // row.
                Self(unsafe { $load(from.as_ptr().cast()) })
            }

            #[inline(always)]
            fn store(self, to: &mut [u32; ROW]) {
                // SAFETY: the instructions are there (see `registers`); no register is longer than a
                // row.
                unsafe { $store(to.as_mut_ptr().cast(), self.0) }
            }

            #[inline(always)]
            fn shl<const BY: i32>(self) -> Self {
                // SAFETY: the instructions are there (see `registers`).
                Self(unsafe { $shl(self.0, $splat(BY)) })
            }

            #[inline(always)]
            fn shr<const BY: i32>(self) -> Self {
                // SAFETY: the instructions are there (see `registers`).
                Self(unsafe { $shr(self.0, $splat(BY)) })
            }

            #[inline(always)]
            fn sar<const BY: i32>(self) -> Self {
                // SAFETY: the instructions are there (see `registers`).
                Self(unsafe { $sar(self.0, $splat(BY)) })
            }

            #[inline(always)]
            fn reverse_bits(self) -> Self {
                let high = self.shr::<4>();
                // SAFETY: the instructions are there (see `registers`).
                unsafe {
                    // Halves of bytes are looked up, the lower ones moved up; then the bytes change
                    // places.
                    let nibbles = $bytes(0x0F);
                    let (low, high) = ($and(self.0, nibbles), $and(high.0, nibbles));
                    let up = $repeat(_mm_setr_epi8(
                        0x00, -0x80, 0x40, -0x40, 0x20, -0x60, 0x60, -0x20, 0x10, -0x70, 0x50,
                        -0x30, 0x30, -0x50, 0x70, -0x10,
                    ));
                    let down = $repeat(_mm_setr_epi8(
                        0x0, 0x8, 0x4, 0xC, 0x2, 0xA, 0x6, 0xE, 0x1, 0x9, 0x5, 0xD, 0x3, 0xB, 0x7,
                        0xF,
                    ));
                    let bytes = $or($look_up(up, low), $look_up(down, high));
                    let places = $repeat(_mm_setr_epi8(
                        3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12,
                    ));
                    Self($look_up(bytes, places))
                }
            }
        }
    };
}
pub(super) use int_lanes;
