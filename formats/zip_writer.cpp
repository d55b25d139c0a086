#include "formats/zip_writer.h"

#include <zip.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <new>

#include "core/base/error.h"

namespace fretwork {
namespace {

/// Feeds packed bytes to libzip, which copies them as they are when told size, method and checksum.
struct PackedSource {
    DeflatedPart part;
    std::size_t at = 0;

    static zip_int64_t call(void* user, void* data, zip_uint64_t length, zip_source_cmd_t command) {
        auto* self = static_cast<PackedSource*>(user);
        switch (command) {
            case ZIP_SOURCE_OPEN:
                self->at = 0;
                return 0;
            case ZIP_SOURCE_READ: {
                const std::size_t count = std::min<std::size_t>(length, self->part.bytes.size() - self->at);
                std::memcpy(data, self->part.bytes.data() + self->at, count);
                self->at += count;
                return static_cast<zip_int64_t>(count);
            }
            case ZIP_SOURCE_STAT:
                self->describe(*static_cast<zip_stat_t*>(data));
                return sizeof(zip_stat_t);
            case ZIP_SOURCE_CLOSE:
            case ZIP_SOURCE_FREE:
                return 0;
            case ZIP_SOURCE_ERROR: {
                const int none[2] = {ZIP_ER_OK, 0};
                std::memcpy(data, none, sizeof none);
                return sizeof none;
            }
            case ZIP_SOURCE_SUPPORTS:
                return zip_source_make_command_bitmap(ZIP_SOURCE_OPEN, ZIP_SOURCE_READ, ZIP_SOURCE_CLOSE,
                                                      ZIP_SOURCE_STAT, ZIP_SOURCE_ERROR, ZIP_SOURCE_FREE, -1);
            default:
                return -1;
        }
    }

    void describe(zip_stat_t& stat) const {
        zip_stat_init(&stat);
        stat.size = part.size;
        stat.comp_size = part.bytes.size();
        stat.crc = part.crc32;
        stat.comp_method = ZIP_CM_DEFLATE;
        stat.valid = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_CRC | ZIP_STAT_COMP_METHOD;
    }
};

}  // namespace

struct ZipWriter::Impl {
    zip_source_t* target = nullptr;
    zip_t* zip = nullptr;
    // A deque, because libzip keeps pointers to these until the archive is closed.
    std::deque<PackedSource> packed;
    std::deque<std::string> stored;

    Impl() {
        zip_error_t error;
        zip_error_init(&error);
        target = zip_source_buffer_create(nullptr, 0, 0, &error);
        if (target != nullptr) zip = zip_open_from_source(target, ZIP_CREATE | ZIP_TRUNCATE, &error);
        zip_error_fini(&error);
        if (zip == nullptr) {
            zip_source_free(target);
            throw std::bad_alloc();
        }
        zip_source_keep(target);
    }
    ~Impl() {
        if (zip != nullptr) zip_discard(zip);
        zip_source_free(target);
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
    if (part.stored)
        add_stored(name, std::move(part.data.bytes));
    else
        add_deflated(name, std::move(part.data));
}

std::string ZipWriter::finish() {
    if (zip_close(impl_->zip) != 0) impl_->fail("closing");
    impl_->zip = nullptr;
    zip_stat_t stat;
    zip_stat_init(&stat);
    if (zip_source_open(impl_->target) != 0) impl_->fail("reading back");
    std::string bytes;
    if (zip_source_stat(impl_->target, &stat) == 0 && (stat.valid & ZIP_STAT_SIZE) != 0) bytes.resize(stat.size);
    const zip_int64_t got = zip_source_read(impl_->target, bytes.data(), bytes.size());
    zip_source_close(impl_->target);
    if (got < 0 || static_cast<std::size_t>(got) != bytes.size() || bytes.empty()) impl_->fail("reading back");
    return bytes;
}

}  // namespace fretwork
