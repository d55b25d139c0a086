// A folder for the files of one run.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <string_view>

namespace fretwork::bench {

/// Goes with the object, with all that is in it.
class ScratchFolder {
  public:
    explicit ScratchFolder(std::string_view name)
        : path_(std::filesystem::temp_directory_path() / fmt::format("fretwork-{}-{}", name, getpid())) {
        std::filesystem::create_directories(path_);
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace fretwork::bench
