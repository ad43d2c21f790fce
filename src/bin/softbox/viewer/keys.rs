//! The keys: the course's own, kept whole, and the common ones. Menus, shortcuts and the key sheet
//! all read this one table.

use eframe::egui::{Context, Event, Key, Modifiers};
use softbox::settings::View;

use super::command::{Binding, Chord, Command, Group, KeyPreset};

const NONE: Modifiers = Modifiers::NONE;
const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

const NUMBERS: [Key; 8] = [
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
    Key::Num5,
    Key::Num6,
    Key::Num7,
    Key::Num8,
];

fn bind(
    group: Group,
    command: Command,
    text: &'static str,
    chords: &[(Modifiers, Key)],
) -> Binding {
    Binding {
        command,
        group,
        text,
        chords: chords
            .iter()
            .map(|&(modifiers, key)| Chord { modifiers, key })
            .collect(),
    }
}

/// All bindings of a preset, in the order of the key sheet.
pub(super) fn bindings(preset: KeyPreset) -> Vec<Binding> {
    let mut all = files();
    all.extend(render(preset));
    all.extend(camera(preset));
    all.extend(view());
    all
}

fn files() -> Vec<Binding> {
    use Command as C;
    let file = |command, text, chords: &[_]| bind(Group::File, command, text, chords);
    vec![
        file(C::Open, "Open…", &[(CTRL, Key::O)]),
        file(C::AskPath, "Open path…", &[(CTRL, Key::L)]),
        file(C::Reload, "Reload", &[(NONE, Key::F5)]),
        file(
            C::SaveSnapshot,
            "Save picture",
            &[(NONE, Key::S), (CTRL, Key::S), (NONE, Key::F12)],
        ),
        file(C::CopyImage, "Copy picture", &[(CTRL, Key::C)]),
        file(
            C::CopyCommandLine,
            "Copy command line",
            &[(CTRL_SHIFT, Key::C)],
        ),
        file(C::DumpCamera, "Write camera file", &[(NONE, Key::D)]),
        file(C::Quit, "Quit", &[(CTRL, Key::Q)]),
    ]
}

fn render(preset: KeyPreset) -> Vec<Binding> {
    use Command as C;
    let render = |command, text, chords: &[_]| bind(Group::Render, command, text, chords);
    let mut pause = vec![(NONE, Key::P)];
    if preset == KeyPreset::Standard {
        pause.push((NONE, Key::Space));
    }
    vec![
        render(C::Restart, "Render again", &[(NONE, Key::R)]),
        render(C::TogglePause, "Pause", &pause),
        render(
            C::HalveSamples,
            "Half the samples per pixel",
            &[(NONE, Key::OpenBracket)],
        ),
        render(
            C::DoubleSamples,
            "Twice the samples per pixel",
            &[(NONE, Key::CloseBracket)],
        ),
        render(
            C::HalveLightSamples,
            "Half the light samples",
            &[(NONE, Key::Minus)],
        ),
        render(
            C::DoubleLightSamples,
            "Twice the light samples",
            &[(NONE, Key::Plus), (NONE, Key::Equals)],
        ),
        render(C::ShallowerPaths, "One bounce less", &[(NONE, Key::Comma)]),
        render(C::DeeperPaths, "One bounce more", &[(NONE, Key::Period)]),
        render(
            C::ToggleHemisphere,
            "Hemisphere or light sampling",
            &[(NONE, Key::H)],
        ),
        render(C::ToggleRegion, "Render region", &[(NONE, Key::C)]),
        render(
            C::Cancel,
            "Cancel, clear the region",
            &[(NONE, Key::Escape)],
        ),
    ]
}

fn camera(preset: KeyPreset) -> Vec<Binding> {
    use Command as C;
    let camera = |command, text, chords: &[_]| bind(Group::Camera, command, text, chords);
    let mut reset = vec![(NONE, Key::Home)];
    if preset == KeyPreset::Cs184 {
        reset.push((NONE, Key::Space));
    }
    vec![
        camera(C::ResetCamera, "Reset camera", &reset),
        camera(C::FrameScene, "Frame the scene", &[(NONE, Key::F)]),
        camera(C::UndoCamera, "Undo camera", &[(CTRL, Key::Z)]),
        camera(
            C::RedoCamera,
            "Redo camera",
            &[(CTRL, Key::Y), (CTRL_SHIFT, Key::Z)],
        ),
        camera(C::NarrowLens, "Smaller lens", &[(NONE, Key::K)]),
        camera(C::WidenLens, "Larger lens", &[(NONE, Key::L)]),
        camera(C::FocusNearer, "Focus nearer", &[(NONE, Key::Semicolon)]),
        camera(C::FocusFarther, "Focus farther", &[(NONE, Key::Quote)]),
    ]
}

fn view() -> Vec<Binding> {
    use Command as C;
    let view = |command, text, chords: &[_]| bind(Group::View, command, text, chords);
    let mut all: Vec<Binding> = View::ALL
        .iter()
        .zip(NUMBERS)
        .map(|(&shown, key)| view(C::Show(shown), view_title(shown), &[(NONE, key)]))
        .collect();
    all.extend([
        view(
            C::ToggleSurfaces,
            "Surfaces without light",
            &[(NONE, Key::E)],
        ),
        view(C::Brighter, "Brighter, half a stop", &[(CTRL, Key::E)]),
        view(C::Darker, "Darker, half a stop", &[(CTRL_SHIFT, Key::E)]),
        view(
            C::ToggleKeys,
            "Keys",
            &[(NONE, Key::F1), (NONE, Key::Questionmark)],
        ),
        view(C::TogglePanels, "Hide panels", &[(NONE, Key::Backtick)]),
        view(C::ToggleFullScreen, "Full screen", &[(NONE, Key::F11)]),
        bind(
            Group::Bvh,
            C::ToggleBvh,
            "Boxes of the BVH",
            &[(NONE, Key::V)],
        ),
        bind(
            Group::Bvh,
            C::ToggleRayLog,
            "Log the camera rays",
            &[(NONE, Key::A)],
        ),
        bind(
            Group::Bvh,
            C::BvhParent,
            "To the parent",
            &[(NONE, Key::ArrowUp)],
        ),
        bind(
            Group::Bvh,
            C::BvhLeft,
            "To the first child",
            &[(NONE, Key::ArrowLeft)],
        ),
        bind(
            Group::Bvh,
            C::BvhRight,
            "To the second child",
            &[(NONE, Key::ArrowRight)],
        ),
    ]);
    all
}

/// The name of a view in menus.
pub(super) fn view_title(view: View) -> &'static str {
    match view {
        View::Render => "Picture",
        View::Normals => "Normals",
        View::GeometricNormals => "Geometric normals",
        View::Albedo => "Albedo",
        View::Depth => "Depth",
        View::Cost => "Cost of the camera ray",
        View::Samples => "Samples per pixel",
        View::Noise => "Noise",
    }
}

/// The chord as people read it, "Ctrl+S" or "[".
pub(super) fn chord_text(ctx: &Context, chord: Chord) -> String {
    let key = match chord.key {
        Key::OpenBracket => "[",
        Key::CloseBracket => "]",
        Key::Minus => "-",
        Key::Plus => "+",
        Key::Equals => "=",
        Key::Comma => ",",
        Key::Period => ".",
        Key::Semicolon => ";",
        Key::Quote => "'",
        Key::Backtick => "`",
        Key::Questionmark => "?",
        Key::ArrowUp => "Up",
        Key::ArrowLeft => "Left",
        Key::ArrowRight => "Right",
        Key::Escape => "Esc",
        key => key.name(),
    };
    match ctx.format_modifiers(chord.modifiers).as_str() {
        "" => key.to_owned(),
        modifiers => format!("{modifiers}+{key}"),
    }
}

/// The command whose keys were pressed in this frame, taking the key presses out of the input.
/// `is_flying` keeps the letters for the moving camera.
pub(super) fn pressed(ctx: &Context, table: &[Binding], is_flying: bool) -> Vec<Command> {
    if ctx.text_edit_focused() {
        return Vec::new();
    }
    // A focused widget keeps the keys that move or press it, an open menu its Escape.
    let keeps = Kept {
        has_focus: ctx.memory(|memory| memory.focused().is_some()),
        has_popup: ctx.any_popup_open(),
        is_flying,
    };
    ctx.input_mut(|input| {
        let mut commands = Vec::new();
        input.events.retain(|event| {
            let command = command_of(event, table, &keeps);
            let is_command = command.is_some();
            commands.extend(command);
            !is_command
        });
        commands
    })
}

/// Who keeps keys from becoming commands.
struct Kept {
    has_focus: bool,
    has_popup: bool,
    is_flying: bool,
}

impl Kept {
    fn keeps(&self, chord: Chord) -> bool {
        let moves_widgets = matches!(
            chord.key,
            Key::ArrowUp | Key::ArrowLeft | Key::ArrowRight | Key::Space
        );
        self.has_focus && moves_widgets
            || self.has_popup && chord.key == Key::Escape
            || self.is_flying && chord.modifiers.is_none()
    }
}

fn command_of(event: &Event, table: &[Binding], kept: &Kept) -> Option<Command> {
    match event {
        // Ctrl+C reaches the program as this event.
        Event::Copy => Some(Command::CopyImage),
        Event::Key {
            key,
            pressed: true,
            modifiers,
            ..
        } => table
            .iter()
            .find(|binding| {
                binding.chords.iter().any(|chord| {
                    chord.key == *key && fits(*chord, *modifiers) && !kept.keeps(*chord)
                })
            })
            .map(|binding| binding.command.clone()),
        _ => None,
    }
}

fn fits(chord: Chord, held: Modifiers) -> bool {
    let ctrl = held.ctrl || held.command || held.mac_cmd;
    let shift_matters = chord.modifiers.command;
    chord.modifiers.command == ctrl
        && !held.alt
        && (!shift_matters || chord.modifiers.shift == held.shift)
}
