use std::sync::LazyLock;

use crate::color::Rgb;

use super::tone_map::{NAN_COLOR, compress};
use super::{DisplaySettings, ToneCurve, display_byte};

/// Values below 2^−18 are displayed as 0 by the fast path.
const LOWEST_EXPONENT: u32 = 127 - 18;
/// Mantissa bits of the table's index: neighbours differ by less than a quarter of a code.
const MANTISSA_BITS: u32 = 10;
const SHIFT: u32 = 23 - MANTISSA_BITS;
const FIRST: u32 = (LOWEST_EXPONENT << 23) >> SHIFT;
const ONE: u32 = (127 << 23) >> SHIFT;

/// One byte for each of 1024 steps of the 18 octaves below 1, and one for 1.
struct Table(Vec<u8>);

impl Table {
    fn new(curve: ToneCurve) -> Self {
        let half_step = 1 << (SHIFT - 1);
        let byte = |index: u32| display_byte(f32::from_bits((index << SHIFT) + half_step), curve);
        let mut bytes: Vec<u8> = (FIRST..ONE).map(byte).collect();
        bytes.push(255);
        Self(bytes)
    }

    /// The byte of a value; NaN gives the byte of 1.
    fn look_up(&self, value: f32) -> u8 {
        let index = value.clamp(0.0, 1.0).to_bits() >> SHIFT;
        match index.checked_sub(FIRST) {
            Some(offset) => self.0[offset.min(ONE - FIRST) as usize],
            None => 0,
        }
    }
}

static SRGB: LazyLock<Table> = LazyLock::new(|| Table::new(ToneCurve::Srgb));
static COURSE: LazyLock<Table> = LazyLock::new(|| Table::new(ToneCurve::Course));

/// Linear pixels as opaque bytes for the live window, by table: at most one code away from
/// [`super::tone_map`]. `out` is overwritten and keeps its memory.
pub fn to_rgba8_fast(pixels: &[Rgb], display: &DisplaySettings, out: &mut Vec<[u8; 4]>) {
    let gain = display.gain();
    let curve = display.tone_curve;
    let table: &Table = if curve == ToneCurve::Course {
        &COURSE
    } else {
        &SRGB
    };
    let byte = |channel: f32| match curve {
        ToneCurve::Srgb | ToneCurve::Course => table.look_up(channel * gain),
        _ => table.look_up(compress(channel * gain, curve)),
    };
    out.clear();
    out.extend(pixels.iter().map(|pixel| {
        let [r, g, b] = if pixel.is_nan() {
            NAN_COLOR
        } else {
            pixel.to_array().map(byte)
        };
        [r, g, b, 255]
    }));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::display::tone_map;

    #[test]
    fn the_table_is_at_most_one_code_off() {
        let mut values: Vec<f32> = (0..300_000).map(|i| i as f32 / 200_000.0).collect();
        values.extend((0..100_000).map(|i| (i as f32 * 0.001 - 60.0).exp2()));
        values.extend([-1.0, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::NAN]);
        let pixels: Vec<Rgb> = values.iter().map(|&v| Rgb::splat(v)).collect();
        let mut fast = vec![[9; 4]; 3];
        for tone_curve in ToneCurve::ALL {
            for exposure in [0.0, -3.0, 2.5] {
                let display = DisplaySettings {
                    exposure,
                    tone_curve,
                };
                to_rgba8_fast(&pixels, &display, &mut fast);
                let exact = tone_map(&pixels, &display);
                assert_eq!(fast.len(), exact.len());
                for ((f, e), v) in fast.iter().zip(&exact).zip(&values) {
                    let off = (0..3).map(|k| f[k].abs_diff(e[k])).max();
                    assert!(off <= Some(1), "{tone_curve:?} {exposure} {v}: {f:?} {e:?}");
                    assert_eq!(f[3], 255);
                }
            }
        }
    }
}
