#include "formats/off_reader.h"

#include <algorithm>
#include <array>
#include <string>

#include "formats/color_channel.h"
#include "formats/polygon_fan.h"
#include "formats/text_scanner.h"

namespace fretwork {
namespace {

constexpr std::size_t kStopEvery = 1 << 14;

/// What the keyword in the first line says each vertex carries.
struct OffKind {
    bool texture = false;
    bool color = false;
    bool normal = false;
};

class OffReader {
  public:
    OffReader(std::string_view bytes, std::string_view source, const RunControl& run)
        : scanner_(bytes, source, {.comment = '#'}), run_(run) {}

    MeshFile read() {
        read_header();
        for (std::size_t v = 0; v < vertices_; ++v) read_vertex(v);
        for (std::size_t f = 0; f < faces_; ++f) read_face(f);
        if (face_colored_ && !face_colors_.empty()) {
            file_.triangle_colors = std::move(face_colors_);
        } else if (kind_.color) {
            file_.triangle_colors = mean_of_corners(file_.mesh.triangles, vertex_colors_);
        }
        if (table_colors_) file_.warnings.emplace_back("colours given as indices of a colour table are not read");
        return std::move(file_);
    }

  private:
    void read_header() {
        std::string_view word = scanner_.word();
        if (word.size() >= 3 && word.substr(word.size() - 3) == "OFF") {
            std::string_view prefix = word.substr(0, word.size() - 3);
            kind_.texture = take(prefix, "ST");
            kind_.color = take(prefix, "C");
            kind_.normal = take(prefix, "N");
            if (!prefix.empty()) scanner_.fail(word, "OFF, COFF, NOFF or STOFF with three coordinates");
            word = scanner_.word();
            if (word == "BINARY") scanner_.fail(word, "OFF as text");
        }
        vertices_ = count_of(word, 6, "the number of vertices");
        faces_ = count_of(scanner_.word(), 8, "the number of faces");
        // The number of edges is never needed and sometimes missing.
        scanner_.next_line();
        file_.mesh.positions_mm.reserve(vertices_);
        file_.mesh.triangles.reserve(faces_);
    }

    static bool take(std::string_view& text, std::string_view prefix) {
        if (!text.starts_with(prefix)) return false;
        text.remove_prefix(prefix.size());
        return true;
    }

    /// A count that the rest of the file can hold, so that a lie cannot make us reserve memory.
    std::size_t count_of(std::string_view word, std::size_t least_bytes_each, std::string_view what) const {
        const std::int64_t count = scanner_.to_integer(word, what);
        const auto most = static_cast<std::int64_t>(scanner_.bytes_left() / least_bytes_each + 1);
        if (count < 0 || count > most)
            scanner_.fail(word, std::string(what) + ", at most " + std::to_string(most) + " in a file of this size");
        return static_cast<std::size_t>(count);
    }

    void read_vertex(std::size_t v) {
        if (v % kStopEvery == 0) run_.throw_if_stopped();
        Vec3 p;
        for (int k = 0; k < 3; ++k) p[k] = scanner_.coordinate("a coordinate");
        file_.mesh.positions_mm.push_back(p);
        if (kind_.normal)
            for (int k = 0; k < 3; ++k) scanner_.to_number(scanner_.word(), "a normal");
        if (kind_.color) {
            std::array<std::string_view, 4> words;
            for (std::size_t k = 0; k < 3; ++k) words[k] = scanner_.word();
            words[3] = scanner_.word_in_line();
            vertex_colors_.push_back(color_of(words[0], words[1], words[2]));
        }
        if (kind_.texture)
            for (int k = 0; k < 2; ++k) scanner_.to_number(scanner_.word(), "a texture coordinate");
    }

    void read_face(std::size_t f) {
        if (f % kStopEvery == 0) run_.throw_if_stopped();
        const std::string_view word = scanner_.word();
        const std::int64_t size = scanner_.to_integer(word, "the number of corners of a face");
        const auto most = static_cast<std::int64_t>(scanner_.bytes_left() / 2 + 1);
        if (size < 1 || size > most) scanner_.fail(word, "a number of corners that the file can hold");
        corners_.clear();
        for (std::int64_t i = 0; i < size; ++i) {
            const std::string_view corner = scanner_.word();
            const std::int64_t vertex = scanner_.to_integer(corner, "a vertex index");
            if (vertex < 0 || vertex >= static_cast<std::int64_t>(vertices_))
                scanner_.fail(corner, "a vertex index below " + std::to_string(vertices_));
            corners_.push_back(static_cast<std::uint32_t>(vertex));
        }
        if (size >= 3) append_polygon(file_.mesh.positions_mm, corners_, file_.mesh.triangles);
        read_face_color();
    }

    void read_face_color() {
        std::array<std::string_view, 4> words;
        std::size_t count = 0;
        for (std::string_view word = scanner_.word_in_line(); !word.empty(); word = scanner_.word_in_line())
            if (count < words.size()) words[count++] = word;
        if (count == 1) table_colors_ = true;
        if (count >= 3) face_colored_ = true;
        const Rgb8 color = count >= 3 ? color_of(words[0], words[1], words[2]) : kUncolored;
        // Colours are kept from the start only as long as some face may need them.
        face_colors_.resize(file_.mesh.triangles.size(), color);
    }

    Rgb8 color_of(std::string_view red, std::string_view green, std::string_view blue) const {
        const std::array<std::string_view, 3> words = {red, green, blue};
        // Integers count to 255. One number with a point or an exponent makes all of them fractions.
        const bool fractions =
            std::ranges::any_of(words, [](auto word) { return word.find_first_of(".eE") != word.npos; });
        Rgb8 color{};
        for (std::size_t k = 0; k < 3; ++k) {
            const double value = scanner_.to_number(words[k], "a colour");
            color[k] = color_from_unit(fractions ? value : value / 255.0);
        }
        return color;
    }

    TextScanner scanner_;
    const RunControl& run_;
    MeshFile file_;
    OffKind kind_;
    std::size_t vertices_ = 0;
    std::size_t faces_ = 0;
    std::vector<Rgb8> vertex_colors_;
    std::vector<Rgb8> face_colors_;
    std::vector<std::uint32_t> corners_;
    bool face_colored_ = false;
    bool table_colors_ = false;
};

}  // namespace

MeshFile read_off(std::string_view bytes, std::string_view source, const RunControl& run) {
    return OffReader(bytes, source, run).read();
}

}  // namespace fretwork
