// A folder of one's own for a while.
#pragma once

#include <filesystem>
#include <string>

namespace fretwork {

class ScratchFolder {
  public:
    /// \throws FileError  it cannot be made.
    ScratchFolder();
    /// With all that is in it, it goes.
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    /// Without links on the way.
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

}  // namespace fretwork
