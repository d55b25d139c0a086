#include "formats/read_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "core/base/error.h"

namespace fretwork {
namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

[[noreturn]] void fail_file(const std::filesystem::path& path, int code) {
    throw FileError(path.string() + ": cannot be read: " + std::strerror(code));
}

}  // namespace

std::string read_file(const std::filesystem::path& path, std::size_t max_bytes) {
    const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
    if (!file) fail_file(path, errno);
    if (std::filesystem::is_directory(path)) fail_file(path, EISDIR);
    std::string bytes;
    // The size is a hint only: pipes have none, and a file may grow while it is read.
    std::error_code no_size;
    const auto size = std::filesystem::file_size(path, no_size);
    if (!no_size && size <= max_bytes) bytes.reserve(static_cast<std::size_t>(size) + 1);
    constexpr std::size_t kBlock = 1 << 20;
    while (true) {
        const std::size_t before = bytes.size();
        bytes.resize(before + kBlock);
        const std::size_t got = std::fread(bytes.data() + before, 1, kBlock, file.get());
        bytes.resize(before + got);
        if (bytes.size() > max_bytes)
            throw InvalidInput(path.string() + ": found more than " + std::to_string(max_bytes) +
                               " bytes, expected a file of at most that size");
        if (got == kBlock) continue;
        if (std::ferror(file.get())) fail_file(path, errno);
        return bytes;
    }
}

}  // namespace fretwork
