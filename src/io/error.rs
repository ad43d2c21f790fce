use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a file could not be read at all. Each message is one sentence that names the file, the
/// place in it where there is one, and what to do.
#[derive(Debug, Error)]
pub enum ImportError {
    /// Nothing at that path.
    #[error("{}: there is no such file; check the spelling of the path.", path.display())]
    NotFound {
        /// The path asked for.
        path: PathBuf,
    },
    /// The file may not be read.
    #[error("{}: permission to read the file was refused; change its permissions or copy it to a place of your own.", path.display())]
    NoPermission {
        /// The path asked for.
        path: PathBuf,
    },
    /// A folder, a device or a pipe.
    #[error("{}: this is {kind}, not a file; name a COLLADA file (.dae).", path.display())]
    NotAFile {
        /// The path asked for.
        path: PathBuf,
        /// What it is, with its article.
        kind: &'static str,
    },
    /// Zero bytes, or nothing but blanks.
    #[error("{}: the file is empty; export or copy it again.", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// Larger than positions in a file can be counted.
    #[error("{}: the file has {bytes} bytes and the limit is {limit}; split the scene into smaller files.", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its size.
        bytes: u64,
        /// The largest size that is read.
        limit: u64,
    },
    /// The operating system failed while reading.
    #[error("{}: reading failed ({source}); check the disk or the network and try again.", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// The file is of a kind that is not read.
    #[error("{}: {found} is not a format softbox reads; export the scene as COLLADA (.dae).", path.display())]
    UnsupportedFormat {
        /// The file.
        path: PathBuf,
        /// What it seems to be.
        found: String,
    },
    /// XML, but not COLLADA.
    #[error("{}, line {line}: the outermost element is <{found}>, not <COLLADA>; export the scene as COLLADA (.dae).", path.display())]
    NotCollada {
        /// The file.
        path: PathBuf,
        /// Line of the element, from 1.
        line: u32,
        /// Name of the outermost element.
        found: String,
    },
    /// The XML is broken beyond safe repair.
    #[error("{}, line {line}, column {column}: the XML is broken here ({problem}); correct that place or export the file again.", path.display())]
    Xml {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: u32,
        /// Column, from 1.
        column: u32,
        /// What the parser says.
        problem: String,
    },
    /// The text ends inside an element.
    #[error("{}, line {line}: the file ends here in the middle of an element, it seems cut off; export or copy it again.", path.display())]
    CutOff {
        /// The file.
        path: PathBuf,
        /// The last line.
        line: u32,
    },
    /// A document type definition, which could define entities without end.
    #[error("{}, line {line}: the file has a document type definition, which is not read for safety; delete the <!DOCTYPE …> block.", path.display())]
    DocumentType {
        /// The file.
        path: PathBuf,
        /// Line of the block, from 1.
        line: u32,
    },
    /// No `<visual_scene>`.
    #[error("{}: the <COLLADA> element has no <visual_scene>, so nothing is placed; export the scene, not only its libraries.", path.display())]
    NoVisualScene {
        /// The file.
        path: PathBuf,
    },
    /// A node that contains itself.
    #[error("{}, line {line}: the node {element} contains itself through <instance_node>; remove that <instance_node>.", path.display())]
    NodeCycle {
        /// The file.
        path: PathBuf,
        /// Line of the `<instance_node>`, from 1.
        line: u32,
        /// Name or id of the node.
        element: String,
    },
    /// Nodes nested too deeply.
    #[error("{}, line {line}: nodes are nested more than {limit} deep; flatten the hierarchy and export again.", path.display())]
    TooDeep {
        /// The file.
        path: PathBuf,
        /// Line of the node that went too deep, from 1.
        line: u32,
        /// The greatest depth that is read.
        limit: usize,
    },
    /// Too many nodes once every `<instance_node>` is expanded.
    #[error("{}, line {line}: the scene expands to more than {limit} nodes; instance fewer copies of the node.", path.display())]
    TooManyNodes {
        /// The file.
        path: PathBuf,
        /// Line of the node that went too far, from 1.
        line: u32,
        /// The greatest number that is read.
        limit: usize,
    },
    /// The progress callback asked to stop.
    #[error("{}: reading was cancelled; open the file again to read all of it.", path.display())]
    Cancelled {
        /// The file.
        path: PathBuf,
    },
}

impl ImportError {
    /// The file that could not be read.
    pub fn path(&self) -> &Path {
        match self {
            Self::NotFound { path }
            | Self::NoPermission { path }
            | Self::NotAFile { path, .. }
            | Self::Empty { path }
            | Self::TooLarge { path, .. }
            | Self::Read { path, .. }
            | Self::UnsupportedFormat { path, .. }
            | Self::NotCollada { path, .. }
            | Self::Xml { path, .. }
            | Self::CutOff { path, .. }
            | Self::DocumentType { path, .. }
            | Self::NoVisualScene { path }
            | Self::NodeCycle { path, .. }
            | Self::TooDeep { path, .. }
            | Self::TooManyNodes { path, .. }
            | Self::Cancelled { path } => path,
        }
    }

    /// The error for a failed system call on `path`.
    pub(super) fn from_io(path: &Path, source: io::Error) -> Self {
        let path = path.to_owned();
        match source.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => Self::NotFound { path },
            io::ErrorKind::PermissionDenied => Self::NoPermission { path },
            _ => Self::Read { path, source },
        }
    }
}
