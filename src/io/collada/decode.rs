/// Text and how it was found in the bytes.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Decoded {
    /// The text without byte order mark.
    pub(super) text: String,
    /// The encoding that was used.
    pub(super) encoding: &'static str,
    /// What was odd about it.
    pub(super) oddity: Option<String>,
}

/// Bytes to text: by byte order mark, by the zero bytes of UTF-16, by the XML declaration, else
/// UTF-8 and at last Latin-1, in which every byte is a letter.
pub(super) fn decode(bytes: Vec<u8>) -> Decoded {
    match bytes.as_slice() {
        [0xFF, 0xFE, rest @ ..] => decode_utf16(rest, u16::from_le_bytes, "UTF-16 LE"),
        [0xFE, 0xFF, rest @ ..] => decode_utf16(rest, u16::from_be_bytes, "UTF-16 BE"),
        [b'<', 0, _, 0, ..] => decode_utf16(&bytes, u16::from_le_bytes, "UTF-16 LE"),
        [0, b'<', 0, _, ..] => decode_utf16(&bytes, u16::from_be_bytes, "UTF-16 BE"),
        [0xEF, 0xBB, 0xBF, rest @ ..] => decode_bytes(rest.to_vec()),
        _ => decode_bytes(bytes),
    }
}

fn decode_utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16, encoding: &'static str) -> Decoded {
    let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    let mut has_lone_surrogate = bytes.len() % 2 == 1;
    let text = char::decode_utf16(units)
        .map(|unit| {
            unit.unwrap_or_else(|_| {
                has_lone_surrogate = true;
                char::REPLACEMENT_CHARACTER
            })
        })
        .collect();
    Decoded {
        text,
        encoding,
        oddity: has_lone_surrogate
            .then(|| format!("some {encoding} code units are invalid and were replaced")),
    }
}

fn decode_bytes(bytes: Vec<u8>) -> Decoded {
    let declared = declared_encoding(&bytes);
    let is_latin1 = matches!(
        declared.as_deref(),
        Some("iso-8859-1" | "iso8859-1" | "latin1" | "latin-1" | "windows-1252" | "cp1252")
    );
    if is_latin1 && !bytes.is_ascii() {
        return Decoded {
            text: latin1(&bytes),
            encoding: "Latin-1",
            oddity: None,
        };
    }
    match String::from_utf8(bytes) {
        Ok(text) => Decoded {
            text,
            encoding: "UTF-8",
            oddity: None,
        },
        Err(error) => Decoded {
            text: latin1(error.as_bytes()),
            encoding: "Latin-1",
            oddity: Some(format!(
                "the text is not valid {}, it was read as Latin-1",
                declared.as_deref().unwrap_or("utf-8")
            )),
        },
    }
}

fn latin1(bytes: &[u8]) -> String {
    bytes.iter().map(|&byte| char::from(byte)).collect()
}

/// The `encoding` of the XML declaration in lower case.
fn declared_encoding(bytes: &[u8]) -> Option<String> {
    let start = &bytes[..bytes.len().min(200)];
    let text = latin1(start);
    let declaration = text.trim_start().strip_prefix("<?xml")?;
    let declaration = &declaration[..declaration.find("?>")?];
    let value = declaration.split_once("encoding")?.1.trim_start();
    let value = value.strip_prefix('=')?.trim_start();
    let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    let value = &value[1..];
    Some(value[..value.find(quote)?].trim().to_ascii_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_of_writing_an_umlaut_reads_the_same() {
        let text = "<a>ü</a>";
        let mut with_mark = vec![0xEF, 0xBB, 0xBF];
        with_mark.extend(text.bytes());
        let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let mut little_mark = vec![0xFF, 0xFE];
        little_mark.extend(&little);
        let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        let latin = b"<a>\xFC</a>".to_vec();
        for (bytes, encoding) in [
            (text.as_bytes().to_vec(), "UTF-8"),
            (with_mark, "UTF-8"),
            (little, "UTF-16 LE"),
            (little_mark, "UTF-16 LE"),
            (big, "UTF-16 BE"),
            (latin, "Latin-1"),
        ] {
            let decoded = decode(bytes);
            assert_eq!((decoded.text.as_str(), decoded.encoding), (text, encoding));
        }
    }

    #[test]
    fn declared_latin1_is_no_oddity_but_broken_utf8_is() {
        let declared = decode(b"<?xml version='1.0' encoding = 'ISO-8859-1'?><a>\xFC</a>".to_vec());
        assert_eq!((declared.encoding, declared.oddity), ("Latin-1", None));
        assert!(decode(b"<a>\xFC</a>".to_vec()).oddity.is_some());
        assert!(decode(vec![0xFF, 0xFE, 0x00, 0xD8]).oddity.is_some());
    }
}
