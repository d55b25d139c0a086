#include "formats/zip_writer.h"

#include <zip.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <new>

#include "core/base/error.h"

namespace fretwork {
namespace {

/// No error, in the form in which libzip asks for the last one.
zip_int64_t tell_no_error(void* data) {
    const int none[2] = {ZIP_ER_OK, 0};
    std::memcpy(data, none, sizeof none);
    return sizeof none;
}

/// Feeds packed bytes to libzip, which copies them once, as they are, when told size, method and checksum. A block
/// goes as soon as it has been copied.
struct PackedSource {
    DeflatedPart part;
    std::uint64_t packed_size = part.packed_size();
    std::size_t block = 0;  ///< that comes next, and how much of it has been read
    std::size_t at = 0;

    static zip_int64_t call(void* user, void* data, zip_uint64_t length, zip_source_cmd_t command) {
        auto* self = static_cast<PackedSource*>(user);
        switch (command) {
            case ZIP_SOURCE_OPEN:
                return self->block == 0 && self->at == 0 ? 0 : -1;
            case ZIP_SOURCE_READ:
                return self->read(static_cast<char*>(data), length);
            case ZIP_SOURCE_STAT:
                self->describe(*static_cast<zip_stat_t*>(data));
                return sizeof(zip_stat_t);
            case ZIP_SOURCE_CLOSE:
            case ZIP_SOURCE_FREE:
                return 0;
            case ZIP_SOURCE_ERROR:
                return tell_no_error(data);
            case ZIP_SOURCE_SUPPORTS:
                return zip_source_make_command_bitmap(ZIP_SOURCE_OPEN, ZIP_SOURCE_READ, ZIP_SOURCE_CLOSE,
                                                      ZIP_SOURCE_STAT, ZIP_SOURCE_ERROR, ZIP_SOURCE_FREE, -1);
            default:
                return -1;
        }
    }

    zip_int64_t read(char* to, zip_uint64_t length) {
        zip_uint64_t done = 0;
        while (done < length && block < part.blocks.size()) {
            std::string& bytes = part.blocks[block];
            const std::size_t count = std::min<std::size_t>(length - done, bytes.size() - at);
            std::copy_n(bytes.data() + at, count, to + done);
            done += count;
            at += count;
            if (at < bytes.size()) break;
            std::string().swap(bytes);
            ++block;
            at = 0;
        }
        return static_cast<zip_int64_t>(done);
    }

    void describe(zip_stat_t& stat) const {
        zip_stat_init(&stat);
        stat.size = part.size;
        stat.comp_size = packed_size;
        stat.crc = part.crc32;
        stat.comp_method = ZIP_CM_DEFLATE;
        stat.valid = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_CRC | ZIP_STAT_COMP_METHOD;
    }
};

/// Where libzip writes the archive: a string, so that there is no second copy of it. Nothing is ever read from it.
struct ArchiveTarget {
    std::string bytes;
    std::size_t at = 0;

    static zip_int64_t call(void* user, void* data, zip_uint64_t length, zip_source_cmd_t command) {
        auto* self = static_cast<ArchiveTarget*>(user);
        switch (command) {
            case ZIP_SOURCE_WRITE:
                self->write(static_cast<const char*>(data), length);
                return static_cast<zip_int64_t>(length);
            case ZIP_SOURCE_SEEK_WRITE:
                return self->seek(data, length);
            case ZIP_SOURCE_TELL_WRITE:
                return static_cast<zip_int64_t>(self->at);
            case ZIP_SOURCE_STAT: {
                auto& stat = *static_cast<zip_stat_t*>(data);
                zip_stat_init(&stat);
                stat.size = self->bytes.size();
                stat.valid = ZIP_STAT_SIZE;
                return sizeof(zip_stat_t);
            }
            case ZIP_SOURCE_OPEN:
            case ZIP_SOURCE_CLOSE:
            case ZIP_SOURCE_BEGIN_WRITE:
            case ZIP_SOURCE_COMMIT_WRITE:
            case ZIP_SOURCE_ROLLBACK_WRITE:
            case ZIP_SOURCE_REMOVE:
            case ZIP_SOURCE_FREE:
                return 0;
            case ZIP_SOURCE_ERROR:
                return tell_no_error(data);
            case ZIP_SOURCE_SUPPORTS:
                // Those for reading are asked for of whatever can be written.
                return ZIP_SOURCE_SUPPORTS_WRITABLE;
            default:
                return -1;
        }
    }

    void write(const char* data, std::size_t length) {
        const std::size_t over = std::min(length, bytes.size() - at);
        std::memcpy(bytes.data() + at, data, over);
        bytes.append(data + over, length - over);
        at += length;
    }

    zip_int64_t seek(void* data, zip_uint64_t length) {
        zip_error_t error;
        const zip_int64_t to = zip_source_seek_compute_offset(at, bytes.size(), data, length, &error);
        if (to < 0) return -1;
        at = static_cast<std::size_t>(to);
        return 0;
    }
};

}  // namespace

struct ZipWriter::Impl {
    ArchiveTarget target;
    zip_t* zip = nullptr;
    // A deque, because libzip keeps pointers to these until the archive is closed.
    std::deque<PackedSource> packed;
    std::deque<std::string> stored;

    Impl() {
        zip_error_t error;
        zip_error_init(&error);
        zip_source_t* source = zip_source_function_create(&ArchiveTarget::call, &target, &error);
        if (source != nullptr) zip = zip_open_from_source(source, ZIP_CREATE | ZIP_TRUNCATE, &error);
        zip_error_fini(&error);
        if (zip == nullptr) {
            zip_source_free(source);
            throw std::bad_alloc();
        }
    }
    ~Impl() {
        if (zip != nullptr) zip_discard(zip);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    /// The packed data and room for what tells of each entry, twice: no more is ever written.
    [[nodiscard]] std::size_t most_bytes() const {
        constexpr std::size_t kMostPerEntry = 4096;
        std::size_t bytes = kMostPerEntry * (packed.size() + stored.size() + 1);
        for (const PackedSource& source : packed) bytes += source.packed_size;
        for (const std::string& part : stored) bytes += part.size();
        return bytes;
    }

    [[noreturn]] void fail(std::string_view what) const {
        throw SolverFailure("zip: " + std::string(what) + ": " + (zip != nullptr ? zip_strerror(zip) : "closed"));
    }

    void add(std::string_view name, zip_source_t* source, zip_int32_t method) {
        if (source == nullptr) fail(name);
        const zip_int64_t index = zip_file_add(zip, std::string(name).c_str(), source, ZIP_FL_ENC_UTF_8);
        if (index < 0) {
            zip_source_free(source);
            fail(name);
        }
        const auto entry = static_cast<zip_uint64_t>(index);
        constexpr zip_uint16_t kMidnight = 0;
        constexpr zip_uint16_t kFirstDayOf1980 = (1 << 5) | 1;
        if (zip_file_set_dostime(zip, entry, kMidnight, kFirstDayOf1980, 0) != 0 ||
            zip_set_file_compression(zip, entry, method, 0) != 0)
            fail(name);
    }
};

ZipWriter::ZipWriter() : impl_(std::make_unique<Impl>()) {}
ZipWriter::~ZipWriter() = default;

void ZipWriter::add(std::string_view name, std::string_view text) {
    add_deflated(name, deflate_pieces(1, [&](std::size_t) { return std::string(text); }));
}

void ZipWriter::add_stored(std::string_view name, std::string bytes) {
    const std::string& kept = impl_->stored.emplace_back(std::move(bytes));
    impl_->add(name, zip_source_buffer(impl_->zip, kept.data(), kept.size(), 0), ZIP_CM_STORE);
}

void ZipWriter::add_deflated(std::string_view name, DeflatedPart part) {
    PackedSource& kept = impl_->packed.emplace_back(PackedSource{std::move(part)});
    impl_->add(name, zip_source_function(impl_->zip, &PackedSource::call, &kept), ZIP_CM_DEFAULT);
}

void ZipWriter::add_packed(std::string_view name, PackedPart part) {
    if (!part.stored) {
        add_deflated(name, std::move(part.data));
        return;
    }
    std::string bytes;
    for (const std::string& block : part.data.blocks) bytes += block;
    add_stored(name, std::move(bytes));
}

std::string ZipWriter::finish() {
    impl_->target.bytes.reserve(impl_->most_bytes());
    if (zip_close(impl_->zip) != 0) impl_->fail("closing");
    impl_->zip = nullptr;
    return std::move(impl_->target.bytes);
}

}  // namespace fretwork
