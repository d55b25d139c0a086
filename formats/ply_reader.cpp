#include "formats/ply_reader.h"

#include <cmath>
#include <string>

#include "formats/byte_order.h"
#include "formats/color_channel.h"
#include "formats/parse_error.h"
#include "formats/ply_header.h"
#include "formats/polygon_fan.h"
#include "formats/text_scanner.h"

namespace fretwork {
namespace {

constexpr std::size_t kStopEvery = 1 << 14;

/// The numbers behind the header, one after the other.
class AsciiNumbers {
  public:
    AsciiNumbers(std::string_view bytes, std::string_view source, const PlyHeader& header)
        : scanner_(bytes.substr(header.data_offset), source, {.comment = 0}), first_line_(header.data_line) {
        source_ = source;
    }

    double next(PlyType) {
        word_ = scanner_.word();
        double value = 0.0;
        if (!parse_number(word_, value)) fail("a number");
        return value;
    }
    [[nodiscard]] std::size_t most_values_left(PlyType) const { return scanner_.bytes_left() / 2 + 1; }
    [[noreturn]] void fail(std::string_view expected) const {
        fail_parse(source_, place_of_line(first_line_ + scanner_.line() - 1),
                   word_.empty() ? "the end of the file" : in_quotes(word_), expected);
    }

  private:
    TextScanner scanner_;
    std::string_view source_;
    std::string_view word_;
    std::size_t first_line_;
};

class BinaryNumbers {
  public:
    BinaryNumbers(std::string_view bytes, std::string_view source, const PlyHeader& header)
        : bytes_(bytes), source_(source), at_(header.data_offset), order_(header.order) {}

    double next(PlyType type) {
        const std::size_t size = size_of(type);
        if (bytes_.size() - at_ < size)
            fail_parse(source_, place_of_byte(bytes_.size()), "the end of the file", "more numbers");
        last_at_ = at_;
        at_ += size;
        last_ = value_at(bytes_.data() + last_at_, type);
        return last_;
    }
    [[nodiscard]] std::size_t most_values_left(PlyType type) const { return (bytes_.size() - at_) / size_of(type); }
    [[noreturn]] void fail(std::string_view expected) const {
        fail_parse(source_, place_of_byte(last_at_), std::to_string(last_), expected);
    }

  private:
    double value_at(const char* at, PlyType type) const {
        switch (type) {
            case PlyType::kInt8:
                return load<std::int8_t>(at, order_);
            case PlyType::kUint8:
                return load<std::uint8_t>(at, order_);
            case PlyType::kInt16:
                return load<std::int16_t>(at, order_);
            case PlyType::kUint16:
                return load<std::uint16_t>(at, order_);
            case PlyType::kInt32:
                return load<std::int32_t>(at, order_);
            case PlyType::kUint32:
                return load<std::uint32_t>(at, order_);
            case PlyType::kFloat32:
                return static_cast<double>(load<float>(at, order_));
            case PlyType::kFloat64:
                break;
        }
        return load<double>(at, order_);
    }

    std::string_view bytes_;
    std::string_view source_;
    std::size_t at_;
    std::size_t last_at_ = 0;
    double last_ = 0.0;
    std::endian order_;
};

std::uint8_t channel(double value, PlyType type) {
    switch (type) {
        case PlyType::kFloat32:
        case PlyType::kFloat64:
            return color_from_unit(value);
        case PlyType::kUint16:
        case PlyType::kInt16:
            return color_from_unit(value / 65535.0);
        default:
            return color_from_unit(value / 255.0);
    }
}

template <class Numbers>
class PlyBody {
  public:
    PlyBody(Numbers numbers, const PlyHeader& header, const RunControl& run)
        : numbers_(std::move(numbers)), header_(header), run_(run) {
        for (const PlyElement& element : header_.elements)
            if (element.name == "vertex") vertex_count_ += element.count;
    }

    MeshFile read() {
        for (const PlyElement& element : header_.elements) {
            if (element.properties.empty()) continue;
            const bool faces = element.name == "face" || element.name == "tristrips";
            for (std::size_t row = 0; row < element.count; ++row) {
                if (row % kStopEvery == 0) run_.throw_if_stopped();
                read_row(element);
                if (element.name == "vertex") take_vertex(element);
                if (faces) take_face(element, element.name == "tristrips");
            }
        }
        finish();
        return std::move(file_);
    }

  private:
    /// Fills `row_` with the scalars, and `list_` with the list of vertex indices.
    void read_row(const PlyElement& element) {
        row_.resize(element.properties.size());
        list_.clear();
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const PlyProperty& property = element.properties[i];
            if (!property.is_list) {
                row_[i] = numbers_.next(property.type);
                if (element.name == "vertex" && (property.name == "x" || property.name == "y" || property.name == "z"))
                    check_coordinate(row_[i]);
                continue;
            }
            const double length = numbers_.next(property.count_type);
            if (!(length >= 0.0) || length > static_cast<double>(numbers_.most_values_left(property.type)))
                numbers_.fail("a list that the file can hold");
            const bool wanted = property.name == "vertex_indices" || property.name == "vertex_index";
            for (double k = 0; k < length; ++k) {
                const double value = numbers_.next(property.type);
                if (wanted) list_.push_back(checked_index(value, element.name == "tristrips"));
            }
        }
    }

    void check_coordinate(double value) const {
        if (!(std::abs(value) <= kMaxCoordinate)) numbers_.fail("a finite coordinate of at most 1e9 in size");
    }

    std::uint32_t checked_index(double value, bool restart_allowed) const {
        if (restart_allowed && value == -1.0) return kRestart;
        if (!(value >= 0.0) || value >= static_cast<double>(vertex_count_) || value != std::floor(value))
            numbers_.fail("a vertex index below " + std::to_string(vertex_count_));
        return static_cast<std::uint32_t>(value);
    }

    bool read_color(const PlyElement& element, Rgb8& color) const {
        const std::size_t red = element.find("red"), green = element.find("green"), blue = element.find("blue");
        const std::size_t none = element.properties.size();
        if (red == none || green == none || blue == none) return false;
        color = {channel(row_[red], element.properties[red].type), channel(row_[green], element.properties[green].type),
                 channel(row_[blue], element.properties[blue].type)};
        return true;
    }

    void take_vertex(const PlyElement& element) {
        const std::size_t x = element.find("x"), y = element.find("y"), z = element.find("z");
        const std::size_t none = element.properties.size();
        if (x == none || y == none || z == none) numbers_.fail("vertices with x, y and z");
        file_.mesh.positions_mm.emplace_back(row_[x], row_[y], row_[z]);
        Rgb8 color{};
        if (read_color(element, color)) vertex_colors_.push_back(color);
    }

    void take_face(const PlyElement& element, bool strips) {
        if (strips) {
            append_strips();
        } else if (list_.size() >= 3) {
            pending_.push_back(list_.size());
            corners_.insert(corners_.end(), list_.begin(), list_.end());
            Rgb8 color{};
            if (read_color(element, color)) polygon_colors_.push_back(color);
        }
    }

    void append_strips() {
        std::size_t begin = 0;
        for (std::size_t i = 0; i <= list_.size(); ++i) {
            if (i < list_.size() && list_[i] != kRestart) continue;
            for (std::size_t k = begin; k + 2 < i; ++k) {
                const bool odd = (k - begin) % 2 == 1;
                const Triangle t = {list_[k + (odd ? 1 : 0)], list_[k + (odd ? 0 : 1)], list_[k + 2]};
                if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;  // Stitches between strips.
                corners_.insert(corners_.end(), t.begin(), t.end());
                pending_.push_back(3);
            }
            begin = i + 1;
        }
    }

    /// Faces may come before the vertices, so polygons are cut at the end.
    void finish() {
        if (file_.mesh.positions_mm.size() != vertex_count_) numbers_.fail("vertices with x, y and z");
        const bool colored = polygon_colors_.size() == pending_.size();
        file_.mesh.triangles.reserve(pending_.size());
        std::size_t first = 0;
        for (std::size_t p = 0; p < pending_.size(); ++p) {
            if (p % kStopEvery == 0) run_.throw_if_stopped();
            append_polygon(file_.mesh.positions_mm, {corners_.data() + first, pending_[p]}, file_.mesh.triangles);
            first += pending_[p];
            if (colored) file_.triangle_colors.resize(file_.mesh.triangles.size(), polygon_colors_[p]);
        }
        if (!colored || pending_.empty()) {
            file_.triangle_colors.clear();
            if (!vertex_colors_.empty() && vertex_colors_.size() == file_.mesh.positions_mm.size())
                file_.triangle_colors = mean_of_corners(file_.mesh.triangles, vertex_colors_);
        }
    }

    static constexpr std::uint32_t kRestart = 0xFFFFFFFFu;

    Numbers numbers_;
    const PlyHeader& header_;
    const RunControl& run_;
    MeshFile file_;
    std::size_t vertex_count_ = 0;
    std::vector<double> row_;
    std::vector<std::uint32_t> list_;
    std::vector<std::uint32_t> corners_;  ///< of all polygons
    std::vector<std::size_t> pending_;    ///< corners of each polygon
    std::vector<Rgb8> vertex_colors_;
    std::vector<Rgb8> polygon_colors_;
};

}  // namespace

MeshFile read_ply(std::string_view bytes, std::string_view source, const RunControl& run) {
    const PlyHeader header = read_ply_header(bytes, source);
    if (header.ascii) return PlyBody<AsciiNumbers>({bytes, source, header}, header, run).read();
    return PlyBody<BinaryNumbers>({bytes, source, header}, header, run).read();
}

}  // namespace fretwork
