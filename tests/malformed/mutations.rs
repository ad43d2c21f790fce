//! Good files with random damage.

use crate::check_sentence;
use crate::collada_text::load_bytes;

/// A small linear congruential generator (Knuth's MMIX constants), enough to choose damage.
struct Dice(u64);

impl Dice {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % limit
    }
}

/// Pieces that readers trip over.
const PIECES: [&[u8]; 14] = [
    b"-1",
    b"nan",
    b"1e999",
    b"99999999999999999999",
    b"<",
    b">",
    b"\"",
    b"&",
    b"\0",
    b"\xFF",
    b"<p>",
    b"</node>",
    b"#",
    b" ",
];

fn damage(dice: &mut Dice, bytes: &mut Vec<u8>) {
    let at = dice.below(bytes.len());
    let end = (at + dice.below(60)).min(bytes.len());
    match dice.below(5) {
        0 => {
            bytes.drain(at..end);
        }
        1 => {
            let copy = bytes[at..end].to_vec();
            let to = dice.below(bytes.len());
            bytes.splice(to..to, copy);
        }
        2 => bytes[at] = dice.below(256) as u8,
        // A digit for a digit keeps the XML whole and breaks what the numbers mean.
        3 => {
            if let Some(digit) = bytes[at..].iter().position(u8::is_ascii_digit) {
                let piece = PIECES[dice.below(4)].iter().copied();
                bytes.splice(at + digit..=at + digit, piece);
            }
        }
        _ => {
            let piece = PIECES[dice.below(PIECES.len())].iter().copied();
            bytes.splice(at..at, piece);
        }
    }
}

#[test]
fn random_damage_never_panics() {
    let assets = [
        include_bytes!("../../assets/cornell-mirror-glass.dae").as_slice(),
        include_bytes!("../../assets/many-lights.dae"),
        include_bytes!("../../assets/lights.dae"),
    ];
    let mut dice = Dice(1);
    let (mut errors, mut scenes) = (0, 0);
    for round in 0..1500 {
        let mut bytes = assets[round % assets.len()].to_vec();
        for _ in 0..=dice.below(3) {
            damage(&mut dice, &mut bytes);
        }
        match load_bytes(&bytes) {
            Ok(_) => scenes += 1,
            Err(error) => {
                check_sentence(&error, "");
                errors += 1;
            }
        }
    }
    assert!(errors > 300 && scenes > 300, "{errors} {scenes}");
}
