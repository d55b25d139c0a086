// Files appear whole or not at all.
#include "formats/atomic_write.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>

#include "core/base/error.h"
#include "formats/read_file.h"
#include "formats/scratch_folder.h"

namespace fretwork {
namespace {

namespace fs = std::filesystem;

std::size_t files_in(const ScratchFolder& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder.path()), {}));
}

TEST_CASE("atomic write: new and replaced files hold exactly the bytes", "[formats]") {
    const ScratchFolder folder;
    const std::string bytes("zero \0 and newline\n", 19);
    atomic_write(folder / "out.stl", bytes);
    CHECK(read_file(folder / "out.stl") == bytes);
    atomic_write(folder / "out.stl", "shorter");
    CHECK(read_file(folder / "out.stl") == "shorter");
    atomic_write(folder / "out.stl", "");
    CHECK(read_file(folder / "out.stl").empty());
    CHECK(files_in(folder) == 1);
}

TEST_CASE("atomic write: permissions are those of an ordinary file, or of the one replaced", "[formats]") {
    const ScratchFolder folder;
    const mode_t mask = ::umask(022);
    atomic_write(folder / "new", "x");
    ::umask(mask);
    struct stat status {};
    REQUIRE(::stat((folder / "new").c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == 0644);
    fs::permissions(folder / "new", fs::perms::owner_read | fs::perms::owner_write);
    atomic_write(folder / "new", "y");
    REQUIRE(::stat((folder / "new").c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == 0600);
}

TEST_CASE("atomic write: a symbolic link stays one", "[formats]") {
    const ScratchFolder folder;
    atomic_write(folder / "real", "old");
    fs::create_symlink("real", folder / "link");
    atomic_write(folder / "link", "new");
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(read_file(folder / "real") == "new");
}

TEST_CASE("atomic write: on failure the target is untouched and nothing is left behind", "[formats][errors]") {
    const ScratchFolder folder;
    atomic_write(folder / "kept", "precious");

    SECTION("no such folder") {
        CHECK_THROWS_WITH(atomic_write(folder / "none/out.stl", "x"), Catch::Contains("none/out.stl"));
    }
    SECTION("the target is a folder") {
        fs::create_directory(folder / "sub");
        CHECK_THROWS_AS(atomic_write(folder / "sub", "x"), FileError);
        fs::remove(folder / "sub");
    }
    SECTION("no space left") {
        // A limit on the size of files stands for a full disk: write fails half way.
        rlimit old{};
        REQUIRE(::getrlimit(RLIMIT_FSIZE, &old) == 0);
        auto* const previous = std::signal(SIGXFSZ, SIG_IGN);
        const rlimit small{4096, old.rlim_max};
        REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
        CHECK_THROWS_AS(atomic_write(folder / "kept", std::string(100000, 'x')), FileError);
        CHECK(::setrlimit(RLIMIT_FSIZE, &old) == 0);
        std::signal(SIGXFSZ, previous);
    }
    CHECK(read_file(folder / "kept") == "precious");
    CHECK(files_in(folder) == 1);
}

TEST_CASE("same_file: sees through spelling and links", "[formats]") {
    const ScratchFolder folder;
    atomic_write(folder / "a", "x");
    fs::create_hard_link(folder / "a", folder / "b");
    fs::create_symlink(folder / "a", folder / "c");
    atomic_write(folder / "d", "x");
    CHECK(same_file(folder / "a", folder.path() / "." / "a"));
    CHECK(same_file(folder / "a", folder / "b"));
    CHECK(same_file(folder / "c", folder / "b"));
    CHECK(!same_file(folder / "a", folder / "d"));
    CHECK(!same_file(folder / "a", folder / "missing"));
    CHECK(!same_file(folder / "missing", folder / "missing"));
}

TEST_CASE("read_file: missing files, folders and files over the limit are refused", "[formats][errors]") {
    const ScratchFolder folder;
    atomic_write(folder / "ten", "0123456789");
    CHECK(read_file(folder / "ten", 10) == "0123456789");
    CHECK_THROWS_AS(read_file(folder / "ten", 9), InvalidInput);
    CHECK_THROWS_AS(read_file(folder / "none"), FileError);
    CHECK_THROWS_AS(read_file(folder.path()), FileError);
}

}  // namespace
}  // namespace fretwork
