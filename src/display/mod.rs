//! Floor 4: from linear pixels to displayed bytes. Exposure, tone curves, false colours; nothing
//! here ever changes or restarts a render.

mod false_color;
mod fast;
mod settings;
mod tone_map;

pub use false_color::{ColorMap, false_color, value_range};
pub use fast::to_rgba8_fast;
pub use settings::{DisplaySettings, ToneCurve};
pub use tone_map::{display_byte, tone_map, tone_map_pixel};
