#include "formats/stl_reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

#include "formats/byte_order.h"
#include "formats/parse_error.h"
#include "formats/text_scanner.h"
#include "formats/weld_equal.h"

namespace fretwork {
namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kTriangleBytes = 50;
constexpr std::size_t kStopEvery = 1 << 14;  ///< triangles between two looks at the stop request

std::size_t declared_triangles(std::string_view bytes) {
    return load<std::uint32_t>(bytes.data() + 80, std::endian::little);
}

bool starts_with_solid(std::string_view bytes) {
    const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
    if (begin == bytes.npos) return false;
    constexpr std::string_view kSolid = "solid";
    const std::string_view word = bytes.substr(begin, kSolid.size());
    return std::ranges::equal(word, kSolid, {}, [](char c) { return std::tolower(static_cast<unsigned char>(c)); });
}

bool is_binary(std::string_view bytes) {
    if (bytes.size() >= kHeaderBytes && bytes.size() == kHeaderBytes + kTriangleBytes * declared_triangles(bytes))
        return true;
    // Text holds no zero byte; a cut-off binary file holds one in the header or in the first count.
    return !starts_with_solid(bytes) || bytes.substr(0, 512).find('\0') != bytes.npos;
}

double checked(float value, std::string_view source, std::size_t offset) {
    if (!std::isfinite(value) || std::abs(static_cast<double>(value)) > kMaxCoordinate)
        fail_parse(source, place_of_byte(offset), "coordinate " + std::to_string(value),
                   "a finite number of at most 1e9 in size");
    return value;
}

MeshFile read_binary(std::string_view bytes, std::string_view source, const RunControl& run) {
    if (bytes.size() < kHeaderBytes)
        fail_parse(source, place_of_byte(bytes.size()), "the end of the file", "an STL header of 84 bytes");
    const std::size_t count = declared_triangles(bytes);
    const std::size_t whole = (bytes.size() - kHeaderBytes) / kTriangleBytes;
    if (whole < count)
        fail_parse(source, place_of_byte(bytes.size()), "the end of the file in triangle " + std::to_string(whole),
                   std::to_string(count) + " triangles of 50 bytes");
    MeshFile file;
    if (bytes.size() != kHeaderBytes + kTriangleBytes * count)
        file.warnings.push_back(std::to_string(bytes.size() - kHeaderBytes - kTriangleBytes * count) +
                                " bytes after the last triangle were skipped");
    file.mesh.triangles.reserve(count);
    EqualPointWelder welder(3 * count);
    for (std::size_t t = 0; t < count; ++t) {
        if (t % kStopEvery == 0) run.throw_if_stopped();
        Triangle triangle;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::size_t offset = kHeaderBytes + kTriangleBytes * t + 12 + 12 * corner;
            Vec3 p;
            for (std::size_t k = 0; k < 3; ++k)
                p[static_cast<int>(k)] =
                    checked(load<float>(bytes.data() + offset + 4 * k, std::endian::little), source, offset + 4 * k);
            triangle[corner] = welder.index_of(p);
        }
        file.mesh.triangles.push_back(triangle);
    }
    file.mesh.positions_mm = welder.take_positions();
    return file;
}

class AsciiReader {
  public:
    AsciiReader(std::string_view bytes, std::string_view source, const RunControl& run)
        : scanner_(bytes, source, {.comment = 0}), welder_(bytes.size() / 80), run_(run) {}

    MeshFile read() {
        for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) {
            if (!same(word, "solid")) scanner_.fail(word, "\"solid\"");
            read_solid(std::string(scanner_.rest_of_line()));
        }
        file_.mesh.positions_mm = welder_.take_positions();
        return std::move(file_);
    }

  private:
    static bool same(std::string_view word, std::string_view keyword) {
        return std::ranges::equal(word, keyword, {},
                                  [](char c) { return std::tolower(static_cast<unsigned char>(c)); });
    }

    void expect(std::string_view keyword) {
        const std::string_view word = scanner_.word();
        if (!same(word, keyword)) scanner_.fail(word, in_quotes(keyword));
    }

    void read_solid(std::string name) {
        const auto first = static_cast<std::uint32_t>(file_.mesh.triangles.size());
        while (true) {
            const std::string_view word = scanner_.word();
            if (same(word, "endsolid")) break;
            if (!same(word, "facet")) scanner_.fail(word, "\"facet\" or \"endsolid\"");
            read_facet();
        }
        scanner_.next_line();
        const auto count = static_cast<std::uint32_t>(file_.mesh.triangles.size()) - first;
        file_.parts.push_back({std::move(name), first, count});
    }

    void read_facet() {
        if (file_.mesh.triangles.size() % kStopEvery == 0) run_.throw_if_stopped();
        expect("normal");
        // Exporters write "nan" here for slivers; the value is not used, so it is not judged.
        for (int k = 0; k < 3; ++k)
            if (scanner_.word().empty()) scanner_.fail({}, "a normal of three numbers");
        expect("outer");
        expect("loop");
        Triangle triangle;
        for (std::uint32_t& corner : triangle) {
            expect("vertex");
            Vec3 p;
            for (int k = 0; k < 3; ++k) p[k] = scanner_.coordinate("a coordinate");
            corner = welder_.index_of(p);
        }
        expect("endloop");
        expect("endfacet");
        file_.mesh.triangles.push_back(triangle);
    }

    TextScanner scanner_;
    EqualPointWelder welder_;
    const RunControl& run_;
    MeshFile file_;
};

}  // namespace

MeshFile read_stl(std::string_view bytes, std::string_view source, const RunControl& run) {
    if (bytes.empty()) fail_parse(source, place_of_byte(0), "an empty file", "an STL");
    return is_binary(bytes) ? read_binary(bytes, source, run) : AsciiReader(bytes, source, run).read();
}

}  // namespace fretwork
