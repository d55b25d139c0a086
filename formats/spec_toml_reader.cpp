#include "formats/spec_toml_reader.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/error.h"

namespace {
/// What toml++ 3.3 takes for granted about its input without having looked, as after "[ =".
struct TomlSurprise {};

constexpr void check_toml(bool as_expected) {
    if (!as_expected) throw TomlSurprise();
}
}  // namespace

// With NDEBUG the library would turn these assertions into promises to the compiler: undefined behaviour
// on a hostile text. Here they end the parse.
#undef NDEBUG
#define TOML_EXCEPTIONS 1
#define TOML_ASSERT(expression) check_toml(static_cast<bool>(expression))
#include <toml++/toml.h>

#include "formats/read_file.h"

namespace fretwork {
namespace {

constexpr std::size_t kMaxTextBytes = 1 << 20;
constexpr int kMaxDepth = 32;

/// Something found in the text, with its position to sort by.
template <class T>
struct Placed {
    toml::source_position position;
    T found;
};

template <class T>
std::vector<T> in_order_of_text(std::vector<Placed<T>> items) {
    // toml++ sorts keys by name; people read files from top to bottom.
    std::ranges::stable_sort(items, [](const auto& a, const auto& b) { return a.position < b.position; });
    std::vector<T> found;
    for (auto& item : items) found.push_back(std::move(item.found));
    return found;
}

class TomlFlattener {
  public:
    explicit TomlFlattener(std::string_view source) : source_(source) {}

    SpecDocument flatten(const toml::table& root) {
        std::vector<Placed<SettingAssignment>> assignments;
        add_table(root, "", assignments, 0, /*within_list=*/false);
        return {in_order_of_text(std::move(assignments)), in_order_of_text(std::move(tables_))};
    }

    [[nodiscard]] std::string place_of(const toml::source_position& at) const {
        return source_ + ": line " + std::to_string(at.line) + ", column " + std::to_string(at.column);
    }

  private:
    [[noreturn]] void fail(const toml::source_position& at, const std::string& key, const std::string& what) const {
        throw InvalidSetting(place_of(at) + ": " + key + ": " + what);
    }

    void add_table(const toml::table& table, const std::string& prefix,
                   std::vector<Placed<SettingAssignment>>& assignments, int depth, bool within_list) {
        for (const auto& [key, node] : table) {
            const std::string name = prefix + std::string(key.str());
            const toml::source_position at = key.source().begin;
            if (depth > kMaxDepth) fail(at, name, "found tables nested over 32 deep, expected fewer");
            if (const toml::table* inner = node.as_table()) {
                add_table(*inner, name + ".", assignments, depth + 1, within_list);
            } else if (const toml::array* list = node.as_array(); list != nullptr && list->is_array_of_tables()) {
                if (within_list) fail(at, name, "found a list of tables within another, expected a value");
                add_list_of_tables(*list, name, depth);
            } else {
                assignments.push_back({at, {name, value_of(node, name, at), place_of(at)}});
            }
        }
    }

    void add_list_of_tables(const toml::array& list, const std::string& name, int depth) {
        for (const toml::node& item : list) {
            const toml::source_position at = item.source().begin;
            std::vector<Placed<SettingAssignment>> entries;
            add_table(*item.as_table(), "", entries, depth + 1, /*within_list=*/true);
            tables_.push_back({at, {name, in_order_of_text(std::move(entries)), place_of(at)}});
        }
    }

    SettingValue value_of(const toml::node& node, const std::string& name, const toml::source_position& at) const {
        if (const auto* value = node.as_boolean()) return value->get();
        if (const auto* value = node.as_integer()) return value->get();
        if (const auto* value = node.as_string()) return value->get();
        if (const auto* value = node.as_floating_point()) return finite(value->get(), name, at);
        const toml::array* list = node.as_array();
        if (list == nullptr) fail(at, name, "found a date or time, expected a boolean, number, string or list");
        std::vector<double> numbers;
        for (const toml::node& item : *list) {
            const std::optional<double> value = item.is_number() ? item.value<double>() : std::nullopt;
            if (!value) fail(at, name, "found a list that holds something else, expected numbers alone");
            numbers.push_back(finite(*value, name, at));
        }
        return numbers;
    }

    double finite(double value, const std::string& name, const toml::source_position& at) const {
        if (!std::isfinite(value)) fail(at, name, "found a number that is not finite, expected a finite one");
        return value;
    }

    std::string source_;
    std::vector<Placed<SettingTable>> tables_;
};

/// toml++ 3.3 looks for blanks among the code points U+FB26 to U+FEFE in a way that is undefined, so
/// these few (ligatures and Arabic letter forms) are refused, from the block U+FB00 on.
void refuse_fragile_characters(std::string_view text, std::string_view source) {
    std::size_t line = 1;
    for (std::size_t i = 0; i + 2 < text.size(); ++i) {
        if (text[i] == '\n') ++line;
        const std::string_view character = text.substr(i, 3);
        if (character >= "\xEF\xAC\x80" && character < "\xEF\xBB\xBF")
            throw InvalidSetting(std::string(source) + ": line " + std::to_string(line) +
                                 ": found a character from U+FB00 to U+FEFE, expected others");
    }
}

}  // namespace

SpecDocument read_spec_toml(std::string_view text, std::string_view source) {
    if (text.size() > kMaxTextBytes)
        throw InvalidSetting(std::string(source) + ": found " + std::to_string(text.size()) +
                             " bytes, expected a spec of at most 1 MiB");
    refuse_fragile_characters(text, source);
    TomlFlattener flattener(source);
    try {
        return flattener.flatten(toml::parse(text, source));
    } catch (const toml::parse_error& error) {
        throw InvalidSetting(flattener.place_of(error.source().begin) + ": " + std::string(error.description()));
    } catch (const TomlSurprise&) {
        throw InvalidSetting(std::string(source) + ": found a key or table header without a name, expected one");
    }
}

SpecDocument read_spec_toml(const std::filesystem::path& path) {
    return read_spec_toml(read_file(path, kMaxTextBytes), path.string());
}

}  // namespace fretwork
