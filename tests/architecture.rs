//! The floor plan of `src/lib.rs` and the rules around it, held against the source text.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The modules of the library, lowest floor first. A module uses only modules on lower floors.
const FLOORS: [&[&str]; 8] = [
    &["math", "color"],
    &["sampling"],
    &["bvh", "image"],
    &["geometry", "bsdf", "camera", "film", "study"],
    &["light", "guide", "display", "settings"],
    &["scene"],
    &["integrator"],
    &["session", "io"],
];

/// Crates that belong to the window.
const WINDOW_CRATES: [&str; 8] = [
    "eframe",
    "egui",
    "egui_plot",
    "winit",
    "glow",
    "wgpu",
    "rfd",
    "notify",
];

/// A name, and the modules of the library that may use it.
const RESERVED: [(&str, &[&str]); 7] = [
    ("fs", &["io"]),
    ("File", &["io"]),
    ("Instant", &["session", "bvh"]),
    ("SystemTime", &[]),
    ("thread", &["session"]),
    ("rayon", &["session", "bvh"]),
    ("println", &[]),
];

/// Where instructions of the processor are called by name.
const UNSAFE_ROOMS: [&str; 2] = ["src/math/lanes/", "src/bvh/simd/"];

/// Lines of a file without its test module.
const MOST_LINES: usize = 500;

struct Source {
    /// Relative to the package, with `/`.
    name: String,
    text: String,
}

impl Source {
    /// The module of the library that the file belongs to; `None` for the root and the program.
    fn module(&self) -> Option<&str> {
        let inside = self.name.strip_prefix("src/")?;
        let first = inside.split('/').next()?;
        let module = first.strip_suffix(".rs").unwrap_or(first);
        (!matches!(module, "bin" | "lib")).then_some(module)
    }

    /// How many times `super::` leads from the file to the root of the crate.
    fn depth(&self) -> usize {
        let parts = self.name.matches('/').count();
        parts - usize::from(self.name.ends_with("/mod.rs"))
    }
}

fn package() -> PathBuf {
    env!("CARGO_MANIFEST_DIR").into()
}

fn sources(folder: &str) -> Vec<Source> {
    fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder of the package") {
            let path = entry.expect("readable").path();
            if path.is_dir() {
                collect(&path, found);
            } else if path.extension().is_some_and(|e| e == "rs") {
                found.push(path);
            }
        }
    }
    let mut paths = Vec::new();
    collect(&package().join(folder), &mut paths);
    paths.sort();
    let read = |path: PathBuf| {
        let relative = path.strip_prefix(package()).expect("inside");
        Source {
            name: relative.to_string_lossy().replace('\\', "/"),
            text: fs::read_to_string(&path).expect("UTF-8"),
        }
    };
    paths.into_iter().map(read).collect()
}

/// The text without line comments and the insides of one-line strings; lines stay.
fn code(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.lines() {
        let mut is_string = false;
        let mut chars = line.chars().peekable();
        while let Some(c) = chars.next() {
            match c {
                '\\' if is_string => drop(chars.next()),
                '\'' if !is_string && chars.peek() == Some(&'"') => drop(chars.next()),
                '"' => is_string = !is_string,
                '/' if !is_string && chars.peek() == Some(&'/') => break,
                _ if is_string => {}
                _ => out.push(c),
            }
        }
        out.push('\n');
    }
    out
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn first_word(text: &str) -> &str {
    let end = text.find(|c| !is_word(c)).unwrap_or(text.len());
    &text[..end]
}

/// Where `word` stands as a whole word.
fn places<'a>(text: &'a str, word: &'a str) -> impl Iterator<Item = usize> + 'a {
    text.match_indices(word)
        .map(|(at, _)| at)
        .filter(move |at| {
            let after = &text[at + word.len()..];
            !text[..*at].ends_with(is_word) && !after.starts_with(is_word)
        })
}

/// The first names after `crate::`, also in `crate::{…}` groups.
fn crate_paths(code: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for at in places(code, "crate") {
        let Some(rest) = code[at + 5..].strip_prefix("::") else {
            continue;
        };
        let Some(group) = rest.strip_prefix('{') else {
            found.insert(first_word(rest).to_owned());
            continue;
        };
        let mut depth = 0;
        let mut is_first = true;
        for (index, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => is_first = true,
                _ if is_first && is_word(c) => {
                    found.insert(first_word(&group[index..]).to_owned());
                    is_first = false;
                }
                _ => {}
            }
        }
    }
    found
}

/// True when a chain of `super::` leads out of the module; modules inside the file count.
fn climbs_out(code: &str, depth: usize) -> bool {
    let mut inline = 0;
    code.lines().any(|line| {
        if line.starts_with('}') {
            inline = 0;
        } else if line.starts_with("mod ") && line.ends_with('{') {
            inline = 1;
        }
        (1..)
            .take_while(|&n| line.contains(&"super::".repeat(n)))
            .any(|n| n >= depth + inline)
    })
}

fn floor_of(module: &str) -> Option<usize> {
    FLOORS.iter().position(|floor| floor.contains(&module))
}

/// What a file of the library does against the rules of its floor.
fn violations(source: &Source) -> Vec<String> {
    let Some(module) = source.module() else {
        return Vec::new();
    };
    let name = &source.name;
    let code = code(&source.text);
    let Some(own) = floor_of(module) else {
        return vec![format!("{name}: no floor holds the module {module}")];
    };
    let mut wrong = Vec::new();
    for used in crate_paths(&code) {
        match floor_of(&used) {
            _ if used == module => {}
            Some(floor) if floor < own => {}
            Some(_) => wrong.push(format!("{name}: {module} uses {used}, which is not below")),
            None => wrong.push(format!("{name}: crate::{used} is no module of the plan")),
        }
    }
    if climbs_out(&code, source.depth()) {
        wrong.push(format!("{name}: super:: leads out of {module}"));
    }
    for window in WINDOW_CRATES {
        if names_crate(&code, window) {
            wrong.push(format!("{name}: {window} belongs to the viewer"));
        }
    }
    // Asking for the number of cores starts no thread.
    let code = code.replace("std::thread::available_parallelism", "");
    for (word, allowed) in RESERVED {
        if !allowed.contains(&module) && places(&code, word).any(|at| is_path(&code, at, word)) {
            wrong.push(format!("{name}: {word} is not for {module}"));
        }
    }
    wrong
}

fn names_crate(code: &str, krate: &str) -> bool {
    places(code, krate).any(|at| code[at..].starts_with(&format!("{krate}::")))
        || code.contains(&format!("use {krate};"))
}

/// True for `std::fs`, `File::open`, `Instant::now`, `use std::{fs, …}`, `println!`; false for a variant
/// or a field of that name.
fn is_path(code: &str, at: usize, word: &str) -> bool {
    let after = &code[at + word.len()..];
    let before = &code[..at];
    let start = before.rfind([';', '}']).map_or(0, |i| i + 1);
    let is_import = code[start..at].contains("use std");
    after.starts_with("::")
        || after.starts_with("!(")
        || is_import
        || before.ends_with("std::")
        || before.ends_with("fs::")
        || before.ends_with("time::")
}

/// Lines before the test module at the end of the file.
fn lines_without_tests(text: &str) -> usize {
    let lines: Vec<&str> = text.lines().collect();
    let tests = lines
        .windows(2)
        .position(|pair| pair[0] == "#[cfg(test)]" && pair[1].starts_with("mod "));
    tests.unwrap_or(lines.len())
}

/// The lines of the dependency tables without a reason behind `#`.
fn dependencies_without_reason(manifest: &str) -> Vec<&str> {
    let mut is_dependency = false;
    let mut found = Vec::new();
    for line in manifest.lines() {
        if line.starts_with('[') {
            is_dependency = line.contains("dependencies");
            if line.contains("dependencies.") {
                found.push(line);
            }
            continue;
        }
        let reason = line.split_once(" # ").map_or("", |(_, reason)| reason);
        let is_entry = is_dependency && !line.trim().is_empty() && !line.starts_with('#');
        if is_entry && reason.trim().len() < 5 {
            found.push(line);
        }
    }
    found
}

#[test]
fn modules_keep_to_their_floors() {
    let wrong: Vec<String> = sources("src").iter().flat_map(violations).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_plan_is_the_one_in_the_documentation() {
    let root = fs::read_to_string(package().join("src/lib.rs")).expect("the root of the library");
    let declared: BTreeSet<&str> = root
        .lines()
        .filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'))
        .collect();
    let planned: BTreeSet<&str> = FLOORS
        .iter()
        .flat_map(|floor| floor.iter().copied())
        .collect();
    assert_eq!(declared, planned);
    for (number, floor) in FLOORS.iter().enumerate() {
        let start = format!("//!  {number}  ");
        let line = root.lines().find(|line| line.starts_with(&start));
        let line = line.unwrap_or_else(|| panic!("floor {number} is not drawn"));
        for module in *floor {
            assert!(places(line, module).next().is_some(), "{module}: {line}");
        }
    }
}

#[test]
fn only_the_viewer_knows_the_window() {
    for source in sources("src/bin") {
        let code = code(&source.text);
        let is_viewer = source.name.starts_with("src/bin/softbox/viewer/");
        for window in WINDOW_CRATES {
            assert!(
                is_viewer || !names_crate(&code, window),
                "{}: {window}",
                source.name
            );
        }
        if source.name.starts_with("src/bin/softbox/viewer/panels/") {
            for path in ["thread::spawn", "softbox::sampling", "softbox::integrator"] {
                assert!(!code.contains(path), "{}: {path}", source.name);
            }
        }
    }
}

#[test]
fn unsafe_code_has_its_rooms() {
    let all = sources("src");
    let has_it = |source: &Source| places(&code(&source.text), "unsafe").next().is_some();
    for room in UNSAFE_ROOMS {
        assert!(all.iter().any(|s| s.name.starts_with(room) && has_it(s)));
    }
    for source in all.iter().filter(|source| has_it(source)) {
        let is_allowed = UNSAFE_ROOMS
            .iter()
            .any(|room| source.name.starts_with(room));
        assert!(is_allowed, "{}", source.name);
    }
}

#[test]
fn files_are_short_and_modules_introduce_themselves() {
    for source in ["src", "tests", "benches"].into_iter().flat_map(sources) {
        let lines = lines_without_tests(&source.text);
        assert!(lines <= MOST_LINES, "{}: {lines} lines", source.name);
        let is_head = source.name.ends_with("mod.rs") || source.name.ends_with("main.rs");
        assert!(
            !is_head || source.text.starts_with("//! "),
            "{}",
            source.name
        );
    }
}

#[test]
fn every_dependency_has_its_reason() {
    let manifest = fs::read_to_string(package().join("Cargo.toml")).expect("the manifest");
    assert_eq!(dependencies_without_reason(&manifest), Vec::<&str>::new());
}

#[test]
fn the_scanner_sees_paths_and_nothing_else() {
    let paths = |text: &str| {
        let found = crate_paths(&code(text));
        found.into_iter().collect::<Vec<_>>().join(" ")
    };
    assert_eq!(paths("use crate::math::{Ray, Aabb};"), "math");
    assert_eq!(paths("let x = crate::io::load();"), "io");
    assert_eq!(
        paths("use crate::{\n  film::{Film, Tile},\n  io,\n};"),
        "film io"
    );
    assert_eq!(paths("pub(in crate::io) fn f() {}"), "io");
    assert_eq!(
        paths("// crate::io\n//! [`crate::io`]\nlet s = \"crate::io\";"),
        ""
    );
    assert_eq!(paths("mycrate::io; let c = '\"'; crate::math"), "math");
    assert!(climbs_out("use super::io;", 1));
    assert!(!climbs_out("use super::Hit;", 2));
    assert!(climbs_out("use super::super::io;", 2));
    assert!(!climbs_out("mod tests {\n    use super::super::Bvh;\n}", 2));
    assert!(climbs_out(
        "mod tests {\n    use super::super::super::io;\n}",
        2
    ));
}

#[test]
fn a_violation_is_found() {
    let found = |name: &str, text: &str| {
        let source = Source {
            name: name.to_owned(),
            text: text.to_owned(),
        };
        violations(&source).join("; ")
    };
    assert!(found("src/math/ray.rs", "use crate::bvh::Bvh;").contains("math uses bvh"));
    assert!(found("src/io/load.rs", "use crate::session::Snapshot;").contains("not below"));
    assert!(found("src/bvh/mod.rs", "use super::scene::Scene;").contains("leads out"));
    assert!(found("src/settings.rs", "use crate::light::Light;").contains("settings uses light"));
    assert!(found("src/film/mod.rs", "use egui::Color32;").contains("viewer"));
    assert!(found("src/session/mod.rs", "use notify::Watcher;").contains("viewer"));
    assert!(found("src/film/mod.rs", "std::fs::read(path)").contains("fs"));
    assert!(found("src/session/mod.rs", "use std::fs::File;").contains("File"));
    assert!(found("src/scene/mod.rs", "use std::{fmt, fs};").contains("fs"));
    assert!(found("src/io/mod.rs", "let now = Instant::now();").contains("Instant"));
    assert!(found("src/light/mod.rs", "std::thread::spawn(f)").contains("thread"));
    assert!(found("src/film/mod.rs", "println!()").contains("println"));
    assert!(found("src/camera/mod.rs", "use crate::nowhere::X;").contains("no module"));
    assert!(found("src/attic/mod.rs", "").contains("no floor"));
    for (name, text) in [
        ("src/scene/mod.rs", "use crate::math::Ray; NormalRule::File"),
        (
            "src/session/a/b.rs",
            "use super::super::Job; self.changed.notify_all();",
        ),
        ("src/settings.rs", "std::thread::available_parallelism()"),
        ("src/bvh/build.rs", "use std::time::Instant;"),
        ("src/io/load.rs", "use std::fs::File; use crate::io::error;"),
    ] {
        assert_eq!(found(name, text), "", "{name}");
    }
}

#[test]
fn long_files_and_bare_dependencies_are_found() {
    let long = "line\n".repeat(501);
    assert!(lines_without_tests(&long) > MOST_LINES);
    let tested = format!("line\n#[cfg(test)]\nmod tests {{\n{long}}}\n");
    assert_eq!(lines_without_tests(&tested), 1);
    let manifest = "[package]\nname = \"x\"\n[dependencies]\na = \"1\" # does this\nb = \"1\"\n\
                    c = \"1\" # \n[dev-dependencies]\nd = \"1\"\n[profile.dev]\nopt-level = 3\n";
    assert_eq!(
        dependencies_without_reason(manifest),
        ["b = \"1\"", "c = \"1\" # ", "d = \"1\""]
    );
}
