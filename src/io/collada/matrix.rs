use glam::DMat4;
use roxmltree::Node;

use super::numbers;

/// A `<matrix>` as its numbers give it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ReadMatrix {
    /// Sixteen finite numbers.
    Whole(DMat4),
    /// Fifteen numbers, and only one place where a 0, 1 or −1 makes perpendicular axes of them.
    Completed(DMat4),
    /// Anything else.
    Unreadable,
}

/// Reads sixteen numbers, row by row. One of the course's scenes has lost a number of its camera's
/// matrix; such a loss is made good where that can be done in one way only.
pub(super) fn read_matrix(element: Node<'_, '_>) -> ReadMatrix {
    if let Some(matrix) = numbers::matrix(element) {
        return ReadMatrix::Whole(matrix);
    }
    let is_one_short = numbers::words(element).take(16).count() == 15;
    let completed = numbers::array::<15>(element)
        .filter(|_| is_one_short)
        .and_then(complete);
    completed.map_or(ReadMatrix::Unreadable, ReadMatrix::Completed)
}

/// The only right-handed matrix with perpendicular axes among those with one number put in.
fn complete(numbers: [f64; 15]) -> Option<DMat4> {
    if numbers[11..] != [0.0, 0.0, 0.0, 1.0] {
        return None;
    }
    let mut found: Option<DMat4> = None;
    for place in 0..12 {
        for lost in [0.0, 1.0, -1.0] {
            let mut rows = [lost; 16];
            rows[..place].copy_from_slice(&numbers[..place]);
            rows[place + 1..].copy_from_slice(&numbers[place..]);
            let matrix = DMat4::from_cols_array(&rows).transpose();
            if !is_perpendicular(&matrix) {
                continue;
            }
            if found.is_some_and(|other| other != matrix) {
                return None;
            }
            found = Some(matrix);
        }
    }
    found
}

fn is_perpendicular(matrix: &DMat4) -> bool {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.truncate());
    let (Some(x), Some(y), Some(z)) = (x.try_normalize(), y.try_normalize(), z.try_normalize())
    else {
        return false;
    };
    // Exporters write six or seven digits.
    x.cross(y).dot(z) > 1.0 - 1e-6
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec4;
    use roxmltree::Document;

    fn read(text: &str) -> ReadMatrix {
        let text = format!("<matrix>{text}</matrix>");
        read_matrix(Document::parse(&text).unwrap().root_element())
    }

    #[test]
    fn a_lost_number_is_put_back_only_where_there_is_no_choice() {
        let whole = "-1 0 0 0  0 0 1 3  0 1 0 0  0 0 0 1";
        let ReadMatrix::Whole(matrix) = read(whole) else {
            panic!("sixteen numbers");
        };
        assert_eq!(matrix.w_axis, DVec4::new(0.0, 3.0, 0.0, 1.0));
        let short = "-1 0 0 0  0 0 1 3  0 0 0  0 0 0 1";
        assert_eq!(read(short), ReadMatrix::Completed(matrix));
        for text in [
            "",
            "1 2 3",
            "1 0 0 0  0 1 0 0  0 0 1  0 0 0 2",
            "0 0 0 0  0 0 0 0  0 0 0  0 0 0 1",
            "1 0 0 7  0 1 0 0 0 1 7  0 0 0 1",
            "nan 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1",
        ] {
            assert_eq!(read(text), ReadMatrix::Unreadable, "{text}");
        }
    }
}
