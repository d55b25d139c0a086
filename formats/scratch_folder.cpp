#include "formats/scratch_folder.h"

#include <stdlib.h>

#include <system_error>

#include "core/base/error.h"

namespace fretwork {

namespace fs = std::filesystem;

ScratchFolder::ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "fretwork-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw FileError(name + ": no folder could be made");
    path_ = fs::canonical(name);
}

ScratchFolder::~ScratchFolder() {
    std::error_code none;
    fs::remove_all(path_, none);
}

}  // namespace fretwork
