//! Sizes of an image or of a library's objects.

use object::read::elf::ElfFile32;
use object::{
    Endianness, Object, ObjectSection, ObjectSymbol, SectionFlags, SymbolKind,
    read::archive::ArchiveFile,
};

/// Bytes of flash and RAM.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Size {
    /// Code, constants and the image of data.
    pub flash: u64,
    /// Data, without stack.
    pub ram: u64,
}

/// An ELF file for a 32-bit machine.
pub type Elf<'d> = ElfFile32<'d, Endianness>;

const WRITE: u64 = object::elf::SHF_WRITE as u64;
const ALLOC: u64 = object::elf::SHF_ALLOC as u64;

/// Size of a file's sections.
pub fn size<'d>(file: &impl Object<'d>) -> Size {
    let mut size = Size::default();
    for section in file.sections() {
        let SectionFlags::Elf { sh_flags } = section.flags() else {
            continue;
        };
        if sh_flags & ALLOC == 0 {
            continue;
        }
        let zero = section.kind() == object::SectionKind::UninitializedData;
        size.ram += if sh_flags & WRITE != 0 {
            section.size()
        } else {
            0
        };
        size.flash += if zero { 0 } else { section.size() };
    }
    size
}

/// Size of all objects of a static library together.
pub(crate) fn library_size(data: &[u8]) -> object::Result<Size> {
    let archive = ArchiveFile::parse(data)?;
    let mut sum = Size::default();
    for member in archive.members() {
        let object = object::File::parse(member?.data(data)?)?;
        let size = size(&object);
        sum.flash += size.flash;
        sum.ram += size.ram;
    }
    Ok(sum)
}

/// Size of the data of this name.
pub(crate) fn data_size(file: &Elf, name: &str) -> Option<u64> {
    let named = |symbol: &object::read::elf::ElfSymbol32<'_, '_>| {
        symbol.kind() == SymbolKind::Data && symbol.name() == Ok(name)
    };
    file.symbols().find(named).map(|symbol| symbol.size())
}
