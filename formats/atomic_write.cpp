#include "formats/atomic_write.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

#include "core/base/error.h"

namespace fretwork {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_write(const fs::path& path, int code) {
    throw FileError(path.string() + ": cannot be written: " + std::strerror(code));
}

/// The temporary file; gone when this goes, unless it was renamed.
class TemporaryFile {
  public:
    explicit TemporaryFile(const fs::path& target) : target_(target), name_(target.parent_path() / ".") {
        name_.append(target.filename().string()).append(".XXXXXX");
        descriptor_ = ::mkostemp(name_.data(), O_CLOEXEC);
        if (descriptor_ < 0) fail_write(target_, errno);
    }
    ~TemporaryFile() {
        if (descriptor_ >= 0) ::close(descriptor_);
        if (!renamed_) ::unlink(name_.c_str());
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void write(std::string_view bytes) {
        constexpr std::size_t kBlock = std::size_t{1} << 26;
        while (!bytes.empty()) {
            const ssize_t written = ::write(descriptor_, bytes.data(), std::min(bytes.size(), kBlock));
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) fail_write(target_, errno);
            bytes.remove_prefix(static_cast<std::size_t>(written));
        }
    }

    void rename_to_target() {
        struct stat old {};
        const mode_t mask = ::umask(0);
        ::umask(mask);
        const mode_t mode = ::stat(target_.c_str(), &old) == 0 ? (old.st_mode & 07777) : (0666 & ~mask);
        if (::fchmod(descriptor_, mode) != 0 || ::fsync(descriptor_) != 0) fail_write(target_, errno);
        // Some file systems report a full disk only here.
        const int closed = ::close(descriptor_);
        descriptor_ = -1;
        if (closed != 0 || ::rename(name_.c_str(), target_.c_str()) != 0) fail_write(target_, errno);
        renamed_ = true;
    }

  private:
    fs::path target_;
    std::string name_;
    int descriptor_ = -1;
    bool renamed_ = false;
};

}  // namespace

void atomic_write(const fs::path& path, std::string_view bytes) {
    std::error_code ignored;
    fs::path target = fs::is_symlink(path, ignored) ? fs::weakly_canonical(path, ignored) : path;
    if (target.empty()) target = path;
    if (fs::is_directory(target, ignored)) fail_write(path, EISDIR);
    TemporaryFile file(target);
    file.write(bytes);
    file.rename_to_target();
}

bool same_file(const fs::path& a, const fs::path& b) {
    std::error_code missing;
    return fs::equivalent(a, b, missing) && !missing;
}

}  // namespace fretwork
