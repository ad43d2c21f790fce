/// How often each safe fault was repaired.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Repairs {
    /// A `&` that starts no known reference, now `&amp;`.
    pub(super) ampersands: usize,
    /// Characters that XML forbids, now blanks.
    pub(super) forbidden: usize,
}

/// Repairs what can be repaired without a guess about meaning; lines keep their numbers. Comments
/// and CDATA keep their ampersands.
pub(super) fn repair(text: &str) -> (String, Repairs) {
    let mut repairs = Repairs::default();
    let mut out = String::with_capacity(text.len() + 64);
    let mut rest = text;
    while let Some(position) = rest.find(|c| c == '&' || c == '<' || is_forbidden(c)) {
        out.push_str(&rest[..position]);
        rest = &rest[position..];
        let taken = match rest.as_bytes()[0] {
            b'&' if is_reference(rest) => 1,
            b'&' => {
                repairs.ampersands += 1;
                out.push_str("&amp;");
                rest = &rest[1..];
                continue;
            }
            b'<' => literal_len(rest),
            _ => {
                repairs.forbidden += 1;
                out.push(' ');
                let mut chars = rest.chars();
                chars.next();
                rest = chars.as_str();
                continue;
            }
        };
        push_clean(&mut out, &rest[..taken], &mut repairs);
        rest = &rest[taken..];
    }
    out.push_str(rest);
    (out, repairs)
}

fn push_clean(out: &mut String, literal: &str, repairs: &mut Repairs) {
    for c in literal.chars() {
        if is_forbidden(c) {
            repairs.forbidden += 1;
            out.push(' ');
        } else {
            out.push(c);
        }
    }
}

/// Length of the comment or CDATA section at the start of `text`, or 1.
fn literal_len(text: &str) -> usize {
    for (open, close) in [("<!--", "-->"), ("<![CDATA[", "]]>")] {
        if let Some(inside) = text.strip_prefix(open) {
            return inside
                .find(close)
                .map_or(text.len(), |at| open.len() + at + close.len());
        }
    }
    1
}

/// Characters outside XML 1.0's `Char` production.
fn is_forbidden(c: char) -> bool {
    matches!(c, '\0'..='\u{8}' | '\u{B}' | '\u{C}' | '\u{E}'..='\u{1F}' | '\u{FFFE}' | '\u{FFFF}')
}

/// True when `text`, which starts with `&`, starts a predefined or a valid character reference.
fn is_reference(text: &str) -> bool {
    let Some(end) = text.bytes().take(12).position(|byte| byte == b';') else {
        return false;
    };
    let name = &text[1..end];
    let code = if let Some(hex) = name.strip_prefix("#x") {
        u32::from_str_radix(hex, 16).ok()
    } else if let Some(decimal) = name.strip_prefix('#') {
        decimal.parse().ok()
    } else {
        return matches!(name, "amp" | "lt" | "gt" | "quot" | "apos");
    };
    code.and_then(char::from_u32)
        .is_some_and(|c| !is_forbidden(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_broken_changes() {
        let good = "<a b='&lt;&#65;&#x41;'>x &amp; y<!-- a & b --><![CDATA[ & ]]></a>";
        assert_eq!(repair(good), (good.to_owned(), Repairs::default()));
    }

    #[test]
    fn bare_ampersands_and_control_characters_are_repaired() {
        let (text, repairs) = repair("<a n='R&D'>a & b &nbsp; \u{1}c &#0; d<!-- \u{2} --></a>&");
        assert_eq!(
            text,
            "<a n='R&amp;D'>a &amp; b &amp;nbsp;  c &amp;#0; d<!--   --></a>&amp;"
        );
        assert_eq!((repairs.ampersands, repairs.forbidden), (5, 2));
    }
}
