#include "formats/zip_reader.h"

#include <sys/stat.h>
#include <zip.h>

#include <algorithm>
#include <array>
#include <exception>
#include <mutex>
#include <unordered_map>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "formats/lower_case.h"
#include "formats/parse_error.h"

namespace fretwork {
namespace {

constexpr std::size_t kBlockBytes = 1 << 18;

struct DiscardZip {
    void operator()(zip_t* zip) const { zip_discard(zip); }
};
struct CloseZipFile {
    void operator()(zip_file_t* file) const { zip_fclose(file); }
};

/// What is wrong with a name, or nothing.
std::string_view fault_of_name(std::string_view name) {
    if (name.empty() || name.size() > 1024) return "an empty or overlong name";
    if (name.front() == '/') return "an absolute name";
    if (name.find('\\') != name.npos) return "a name with a backslash";
    if (name.find(':') != name.npos) return "a name with a drive or colon";
    if (std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }))
        return "a name with control characters";
    for (std::size_t begin = 0; begin <= name.size();) {
        const std::size_t end = std::min(name.find('/', begin), name.size());
        const std::string_view part = name.substr(begin, end - begin);
        if (part == ".." || part == ".") return "a name that leaves its folder";
        begin = end + 1;
    }
    return {};
}

}  // namespace

struct ZipReader::Impl {
    std::string source;
    ZipLimits limits;
    std::unique_ptr<zip_t, DiscardZip> zip;
    std::vector<Entry> entries;
    std::unordered_map<std::string, std::size_t> by_name;  ///< name in lower case -> position in `entries`
    std::vector<zip_uint64_t> index;                       ///< of each entry within the archive
    mutable std::mutex one_at_a_time;                      ///< all entries share the archive's place of reading

    [[noreturn]] void fail(std::string_view entry, std::string_view found, std::string_view expected) const {
        fail_parse(source, entry.empty() ? std::string("archive") : "entry " + in_quotes(entry), found, expected);
    }

    void open(std::string_view bytes) {
        if (!bytes.starts_with("PK")) fail({}, in_quotes(bytes.substr(0, 4)), "a ZIP archive");
        zip_error_t error;
        zip_error_init(&error);
        zip_source_t* memory = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
        if (memory != nullptr) {
            zip.reset(zip_open_from_source(memory, ZIP_RDONLY, &error));
            if (!zip) zip_source_free(memory);
        }
        const std::string reason = zip ? "" : zip_error_strerror(&error);
        zip_error_fini(&error);
        if (!zip) fail({}, "a broken archive (" + reason + ")", "a ZIP archive");
    }

    void list(std::string_view bytes) {
        const zip_int64_t count = zip_get_num_entries(zip.get(), 0);
        if (count < 0 || static_cast<std::size_t>(count) > limits.max_entries)
            fail({}, std::to_string(count) + " entries", "at most " + std::to_string(limits.max_entries));
        std::uint64_t total = 0;
        for (zip_uint64_t i = 0; i < static_cast<zip_uint64_t>(count); ++i) {
            zip_stat_t stat;
            zip_stat_init(&stat);
            if (zip_stat_index(zip.get(), i, 0, &stat) != 0 || stat.name == nullptr)
                fail({}, "entry " + std::to_string(i) + " without a name", "a sound archive");
            check(stat, i);
            total += stat.size;
            if (std::string_view(stat.name).back() == '/') continue;
            if (!by_name.emplace(lower_case(stat.name), entries.size()).second)
                fail(stat.name, "a second entry of this name", "one entry per name");
            entries.push_back({stat.name, stat.size});
            index.push_back(i);
        }
        // Entries that share their packed bytes can each keep to the ratio and still flood memory together.
        if (total > limits.max_ratio * bytes.size() + (1 << 20))
            fail({}, std::to_string(total) + " bytes unpacked from " + std::to_string(bytes.size()),
                 "a ratio of at most " + std::to_string(limits.max_ratio));
    }

    void check(const zip_stat_t& stat, zip_uint64_t i) const {
        constexpr zip_uint64_t kNeeded =
            ZIP_STAT_NAME | ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD | ZIP_STAT_ENCRYPTION_METHOD;
        if ((stat.valid & kNeeded) != kNeeded) fail(stat.name, "an incomplete record", "sizes and method");
        if (const auto fault = fault_of_name(stat.name); !fault.empty())
            fail(stat.name, fault, "a relative path within the package");
        if (stat.encryption_method != ZIP_EM_NONE) fail(stat.name, "encrypted data", "plain data");
        if (stat.comp_method != ZIP_CM_STORE && stat.comp_method != ZIP_CM_DEFLATE)
            fail(stat.name, "compression method " + std::to_string(stat.comp_method), "stored or deflate");
        if (stat.size > limits.max_part_bytes)
            fail(stat.name, std::to_string(stat.size) + " bytes", "at most " + std::to_string(limits.max_part_bytes));
        if (stat.size > (1 << 20) && stat.size / limits.max_ratio > stat.comp_size)
            fail(stat.name, std::to_string(stat.size) + " bytes packed into " + std::to_string(stat.comp_size),
                 "a ratio of at most " + std::to_string(limits.max_ratio));
        zip_uint8_t system = 0;
        zip_uint32_t attributes = 0;
        if (zip_file_get_external_attributes(zip.get(), i, 0, &system, &attributes) == 0 && system == ZIP_OPSYS_UNIX &&
            S_ISLNK(attributes >> 16))
            fail(stat.name, "a symbolic link", "a file");
    }

    [[nodiscard]] std::size_t find(std::string_view name) const {
        const auto found = by_name.find(lower_case(name));
        if (found == by_name.end()) fail(name, "no such entry", "one");
        return found->second;
    }

    /// Unpacks an entry from its beginning.
    class EntryStream {
      public:
        EntryStream(const Impl& impl, std::size_t position) : impl_(impl), entry_(impl.entries[position]) {
            const std::lock_guard<std::mutex> lock(impl_.one_at_a_time);
            file_.reset(zip_fopen_index(impl_.zip.get(), impl_.index[position], 0));
            if (!file_) impl_.fail(entry_.name, "data that cannot be opened", "a sound entry");
        }
        ~EntryStream() {
            const std::lock_guard<std::mutex> lock(impl_.one_at_a_time);
            file_.reset();
        }
        EntryStream(const EntryStream&) = delete;
        EntryStream& operator=(const EntryStream&) = delete;

        /// What comes next, within `buffer`; nothing at the end.
        std::string_view next(std::vector<char>& buffer) {
            const std::lock_guard<std::mutex> lock(impl_.one_at_a_time);
            const zip_int64_t got = zip_fread(file_.get(), buffer.data(), buffer.size());
            if (got < 0)
                impl_.fail(entry_.name, std::string("broken data (") + zip_file_strerror(file_.get()) + ")",
                           "a sound entry");
            done_ += static_cast<std::uint64_t>(got);
            if (done_ > entry_.size || (got == 0 && done_ != entry_.size))
                impl_.fail(entry_.name, std::to_string(done_) + " bytes",
                           "the " + std::to_string(entry_.size) + " it announces");
            return {buffer.data(), static_cast<std::size_t>(got)};
        }

      private:
        const Impl& impl_;
        const Entry& entry_;
        std::unique_ptr<zip_file_t, CloseZipFile> file_;
        std::uint64_t done_ = 0;
    };

    void read_entry(std::size_t position, const std::function<void(std::string_view)>& take) const {
        EntryStream stream(*this, position);
        const auto bytes = static_cast<std::size_t>(std::clamp<std::uint64_t>(entries[position].size, 1, kBlockBytes));
        std::array<std::vector<char>, 2> buffers = {std::vector<char>(bytes), std::vector<char>(bytes)};
        std::string_view block = stream.next(buffers[0]);
        for (std::size_t turn = 1; !block.empty(); ++turn) {
            std::string_view following;
            std::exception_ptr broken;
            parallel_for(2, 1, [&](std::size_t job) {
                if (job == 0) {
                    take(block);
                    return;
                }
                try {
                    following = stream.next(buffers[turn % 2]);
                } catch (const InvalidInput&) {
                    broken = std::current_exception();
                }
            });
            // What is wrong with the text so far comes before what is wrong further on.
            if (broken) std::rethrow_exception(broken);
            block = following;
        }
    }

    [[nodiscard]] PackedPart read_packed(std::size_t position) const {
        const Entry& entry = entries[position];
        zip_stat_t stat;
        zip_stat_init(&stat);
        const std::lock_guard<std::mutex> lock(one_at_a_time);
        const std::unique_ptr<zip_file_t, CloseZipFile> file(
            zip_fopen_index(zip.get(), index[position], ZIP_FL_COMPRESSED));
        if (!file || zip_stat_index(zip.get(), index[position], 0, &stat) != 0)
            fail(entry.name, "data that cannot be opened", "a sound entry");
        PackedPart part;
        part.stored = stat.comp_method == ZIP_CM_STORE;
        part.data.size = stat.size;
        part.data.crc32 = stat.crc;
        std::string& bytes = part.data.blocks.emplace_back(stat.comp_size, '\0');
        for (std::size_t done = 0; done < bytes.size();) {
            const zip_int64_t got = zip_fread(file.get(), bytes.data() + done, stat.comp_size - done);
            if (got <= 0) fail(entry.name, std::to_string(done) + " packed bytes", std::to_string(stat.comp_size));
            done += static_cast<std::size_t>(got);
        }
        return part;
    }
};

ZipReader::ZipReader(std::string_view bytes, std::string_view source, const ZipLimits& limits)
    : impl_(std::make_unique<Impl>()) {
    impl_->source = source;
    impl_->limits = limits;
    impl_->open(bytes);
    impl_->list(bytes);
}
ZipReader::~ZipReader() = default;
ZipReader::ZipReader(ZipReader&&) noexcept = default;
ZipReader& ZipReader::operator=(ZipReader&&) noexcept = default;

const std::vector<ZipReader::Entry>& ZipReader::entries() const {
    return impl_->entries;
}

bool ZipReader::contains(std::string_view name) const {
    return impl_->by_name.contains(lower_case(name));
}

std::string ZipReader::read(std::string_view name, std::uint64_t max_bytes) const {
    const std::size_t position = impl_->find(name);
    if (const std::uint64_t size = impl_->entries[position].size; size > max_bytes)
        impl_->fail(name, std::to_string(size) + " bytes", "at most " + std::to_string(max_bytes));
    std::string bytes;
    impl_->read_entry(position, [&](std::string_view block) { bytes.append(block); });
    return bytes;
}

PackedPart ZipReader::read_packed(std::string_view name) const {
    return impl_->read_packed(impl_->find(name));
}

void ZipReader::read_blocks(std::string_view name, const std::function<void(std::string_view)>& take) const {
    impl_->read_entry(impl_->find(name), take);
}

}  // namespace fretwork
