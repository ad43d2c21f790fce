use anyhow::anyhow;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::register_font;

use super::report::{Method, SceneReport};

/// Width and height of the picture in pixels.
pub(super) const SIZE: (usize, usize) = (1200, 840);

const FONT: &str = "sans-serif";
const LETTERS: u32 = 20;
/// Told apart by people who see fewer colours too: Okabe and Ito 2008, "Color Universal Design".
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(60, 60, 60),
];

/// Largest over least value up to which an axis has room for more than powers of ten.
const SHORT_AXIS: f64 = 300.0;

/// One curve on the picture.
#[derive(Clone, Debug, PartialEq)]
struct Line {
    label: String,
    /// The first mode of its scene: drawn broad, so that it shows under others.
    is_first: bool,
    /// Processor seconds and relMSE, both above 0.
    points: Vec<(f64, f64)>,
}

/// The curves of all scenes and modes, row by row from the top.
///
/// # Errors
/// When there is no point to draw.
pub(super) fn draw(reports: &[SceneReport]) -> anyhow::Result<Vec<[u8; 3]>> {
    let lines: Vec<Line> = reports
        .iter()
        .flat_map(|report| {
            let methods = report.methods.iter().enumerate();
            methods.map(|(index, method)| line(report, method, index == 0))
        })
        .filter(|line| !line.points.is_empty())
        .collect();
    if lines.is_empty() {
        return Err(anyhow!(
            "There is no point above the noise of the reference to draw."
        ));
    }
    // Refused only for a second font under the same name in the same style.
    let _ = register_font(FONT, FontStyle::Normal, epaint_default_fonts::HACK_REGULAR);
    let mut bytes = vec![255; SIZE.0 * SIZE.1 * 3];
    {
        let size = (SIZE.0 as u32, SIZE.1 as u32);
        let area = BitMapBackend::with_buffer(&mut bytes, size).into_drawing_area();
        draw_on(&area, &lines).map_err(|error| anyhow!("Cannot draw the curves: {error}"))?;
    }
    Ok(bytes.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect())
}

fn line(report: &SceneReport, method: &Method, is_first: bool) -> Line {
    let slope = method
        .power_law
        .map_or(String::new(), |law| format!(", slope {:.2}", law.slope));
    let levels = method.levels.iter();
    Line {
        label: format!("{} {}{slope}", report.scene, method.mode),
        is_first,
        points: levels
            .map(|level| (level.cpu_seconds, level.rel_mse))
            .filter(|&(x, y)| x > 0.0 && y > 0.0)
            .collect(),
    }
}

type Drawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

fn draw_on<B: DrawingBackend>(area: &DrawingArea<B, Shift>, lines: &[Line]) -> Drawn<B> {
    area.fill(&WHITE)?;
    let points = || lines.iter().flat_map(|line| &line.points);
    let (x_range, y_range) = (range(points().map(|p| p.0)), range(points().map(|p| p.1)));
    let mut chart = ChartBuilder::on(area)
        .margin(24)
        .x_label_area_size(64)
        .y_label_area_size(104)
        .build_cartesian_2d(
            (x_range.0..x_range.1).log_scale(),
            (y_range.0..y_range.1).log_scale(),
        )?;
    chart
        .configure_mesh()
        .label_style((FONT, LETTERS))
        .axis_desc_style((FONT, LETTERS + 4))
        .bold_line_style(BLACK.mix(0.25))
        .light_line_style(BLACK.mix(0.08))
        .max_light_lines(1)
        .x_desc("processor seconds")
        .y_desc("relMSE")
        .x_label_formatter(&|&x| tick(x, x_range))
        .y_label_formatter(&|&y| tick(y, y_range))
        .draw()?;
    for (line, color) in lines.iter().zip(COLORS.iter().cycle()) {
        let (width, radius) = if line.is_first { (6, 7) } else { (2, 4) };
        let stroke = color.stroke_width(width);
        chart
            .draw_series(LineSeries::new(line.points.iter().copied(), stroke))?
            .label(line.label.as_str())
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 32, y)], stroke));
        let dots = line.points.iter();
        chart.draw_series(dots.map(|&p| Circle::new(p, radius, color.filled())))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .margin(16)
        .legend_area_size(44)
        .label_font((FONT, LETTERS))
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.4))
        .draw()?;
    area.present()
}

/// From a bit below the least to a bit above the largest of the values.
fn range(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let least = values.clone().fold(f64::INFINITY, f64::min);
    let most = values.fold(0.0, f64::max);
    (least / 1.6, most * 1.6)
}

/// The label of a tick: powers of ten, with their two- and fivefold on a short axis; others go
/// without, for there would be no room.
fn tick(value: f64, axis: (f64, f64)) -> String {
    let is_short = axis.1 / axis.0 < SHORT_AXIS;
    let power = (value.log10() + 1e-6).floor();
    let digit = (value / 10_f64.powf(power)).round();
    if digit == 1.0 || is_short && (digit == 2.0 || digit == 5.0) {
        match power as i32 {
            decimals @ -3..0 => format!("{value:.0$}", decimals.unsigned_abs() as usize),
            0..4 => format!("{value:.0}"),
            _ => format!("{digit}e{power}"),
        }
    } else {
        String::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_named_where_there_is_room() {
        let (short, long) = ((0.01, 1.0), (1e-5, 1.0));
        assert_eq!(tick(0.2, short), "0.2");
        assert_eq!(
            (tick(0.2, long), tick(0.3, short)),
            (String::new(), String::new())
        );
        assert_eq!(tick(0.1, long), "0.1");
        assert_eq!(tick(0.010_000_000_000_000_002, long), "0.01");
        assert_eq!(tick(9.999_999_999e-5, long), "1e-4");
        assert_eq!(
            (tick(5e-6, short), tick(1e4, short)),
            ("5e-6".to_owned(), "1e4".to_owned())
        );
    }
}
