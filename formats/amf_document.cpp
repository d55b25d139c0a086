#include "formats/amf_document.h"

#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "formats/color_channel.h"
#include "formats/mesh_data.h"
#include "formats/parse_error.h"
#include "formats/text_scanner.h"
#include "formats/xml_reader.h"

namespace fretwork::amf {
namespace {

constexpr std::size_t kMaxItems = 1 << 16;  ///< of objects, volumes, constellations, instances, materials
constexpr std::size_t kMaxTextBytes = 1 << 12;
constexpr std::size_t kStopEvery = 1 << 14;

/// A colour or a place that is being read, child by child.
struct Numbers {
    std::array<double, 3> value{};
    bool sound = true;  ///< false once a child was no number
};

class Handler : public XmlHandler {
  public:
    Handler(std::string_view source, const RunControl& run) : xml_(*this, source), run_(run) {}

    XmlReader& xml() { return xml_; }

    Document take() {
        if (!root_seen_) xml_.fail("no amf element", "<amf>");
        for (const std::string& word : skipped_) document_.warnings.push_back("AMF: " + word + " left out");
        return std::move(document_);
    }

    void start(const XmlElement& element) override {
        const std::string name(element.name);
        const std::string_view parent = path_.empty() ? std::string_view() : std::string_view(path_.back());
        text_.clear();
        if (path_.empty()) {
            start_root(element);
        } else if (parent == "amf") {
            start_below_root(element);
        } else if (constellation_ != nullptr && path_.size() == 2 && name == "instance") {
            start_instance(element);
        } else {
            start_in_object(element, parent);
        }
        if (name == "metadata") metadata_type_ = std::string(element.find("type").value_or(""));
        path_.push_back(name);
    }

    void end() override {
        const std::string name = std::move(path_.back());
        path_.pop_back();
        const std::string_view parent = path_.empty() ? std::string_view() : std::string_view(path_.back());
        if (parent == "coordinates") {
            set_number(place_, name, {"x", "y", "z"});
        } else if (parent == "color") {
            set_number(color_, name, {"r", "g", "b"});
        } else if (parent == "triangle" && name.size() == 2 && name[0] == 'v') {
            set_corner(name);
        } else if (parent == "instance") {
            set_placing(name);
        } else if (name == "coordinates") {
            add_vertex();
        } else if (name == "color") {
            keep_color(parent);
        } else if (name == "triangle") {
            add_triangle();
        } else if (name == "volume") {
            close_volume();
        } else if (constellation_ != nullptr && path_.size() == 2 && name == "instance") {
            close_instance();
        } else if (name == "metadata" && metadata_type_ == "name") {
            keep_name(parent);
        } else if (name == "mesh" && object_ != nullptr) {
            check_corners();
        }
    }

    void text(std::string_view characters) override {
        if (text_.size() + characters.size() <= kMaxTextBytes) text_.append(characters);
    }

  private:
    void start_root(const XmlElement& e) {
        if (e.name != "amf") xml_.fail(in_quotes(e.name), "<amf>");
        root_seen_ = true;
        const std::string unit(e.find("unit").value_or("millimeter"));
        static const std::map<std::string, LengthUnit> kUnits = {{"millimeter", LengthUnit::kMillimeter},
                                                                 {"inch", LengthUnit::kInch},
                                                                 {"feet", LengthUnit::kFoot},
                                                                 {"foot", LengthUnit::kFoot},
                                                                 {"meter", LengthUnit::kMeter},
                                                                 {"micron", LengthUnit::kMicron},
                                                                 {"micrometer", LengthUnit::kMicron},
                                                                 {"centimeter", LengthUnit::kCentimeter}};
        const auto known = kUnits.find(unit);
        if (known == kUnits.end()) xml_.fail("unit " + in_quotes(unit), "millimeter, inch, feet, meter or micron");
        document_.unit = known->second;
    }

    std::string id_of(const XmlElement& e) const {
        const auto id = e.find("id");
        if (!id || id->empty()) xml_.fail("<" + std::string(e.name) + "> without an id", "one");
        return std::string(*id);
    }

    template <class Map>
    void check_new(const Map& map, const std::string& id, const std::string& what) const {
        if (map.size() >= kMaxItems) xml_.fail("over 65536 " + what + "s", "fewer");
        if (map.contains(id)) xml_.fail("a second " + what + " " + in_quotes(id), "an id of its own");
    }

    void start_below_root(const XmlElement& e) {
        object_ = nullptr;
        constellation_ = nullptr;
        if (e.name == "object") {
            const std::string id = id_of(e);
            check_new(document_.objects, id, "object");
            document_.order.push_back(id);
            object_ = &document_.objects[id];
            volume_open_ = false;
        } else if (e.name == "constellation") {
            const std::string id = id_of(e);
            check_new(document_.constellations, id, "constellation");
            constellation_ = &document_.constellations[id];
        } else if (e.name == "material") {
            material_ = id_of(e);
            check_new(document_.materials, material_, "material");
        } else if (e.name == "texture") {
            skipped_.insert("textures");
        }
    }

    void start_instance(const XmlElement& e) {
        if (constellation_->size() >= kMaxItems) xml_.fail("over 65536 instances", "fewer");
        const auto target = e.find("objectid");
        if (!target) xml_.fail("an instance without objectid", "one");
        instance_ = {std::string(*target), Eigen::Affine3d::Identity(), xml_.line()};
        moves_ = {};
        turns_deg_ = {};
    }

    void start_in_object(const XmlElement& e, std::string_view parent) {
        if (e.name == "coordinates") place_ = {};
        if (e.name == "color") color_ = {};
        if (object_ == nullptr) return;
        if (e.name == "vertex") vertex_ = static_cast<std::uint32_t>(object_->mesh.positions_mm.size());
        if (parent == "mesh" && e.name == "volume") {
            if (object_->volumes.size() >= kMaxItems) xml_.fail("over 65536 volumes", "fewer");
            object_->volumes.push_back({{},
                                        std::string(e.find("materialid").value_or("")),
                                        {},
                                        static_cast<std::uint32_t>(object_->mesh.triangles.size()),
                                        0});
            volume_open_ = true;
        } else if (parent == "volume" && e.name == "triangle") {
            corners_ = {-1, -1, -1};
            triangle_color_.reset();
        } else if (parent == "vertex" && e.name == "normal") {
            skipped_.insert("curved triangles");
        } else if (e.name == "texmap" || e.name == "map") {
            skipped_.insert("textures");
        }
    }

    double number(const std::string& what) const {
        double value = 0.0;
        if (!parse_number(trimmed(), value)) xml_.fail(what + " " + in_quotes(text_), "a number");
        if (!(std::abs(value) <= kMaxCoordinate)) xml_.fail(what + " " + in_quotes(text_), "at most 1e9 in size");
        return value;
    }

    std::string_view trimmed() const {
        constexpr std::string_view kBlanks = " \t\r\n";
        const std::string_view all = text_;
        const std::size_t first = all.find_first_not_of(kBlanks);
        return first == all.npos ? std::string_view() : all.substr(first, all.find_last_not_of(kBlanks) - first + 1);
    }

    void set_number(Numbers& numbers, const std::string& name, const std::array<std::string_view, 3>& names) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (name != names[k]) continue;
            if (&numbers == &color_) {
                // A formula of the place is allowed here.
                if (!parse_number(trimmed(), numbers.value[k])) numbers.sound = false;
            } else {
                numbers.value[k] = number(name);
            }
        }
    }

    void set_corner(const std::string& name) {
        if (name[1] < '1' || name[1] > '3') return;
        std::int64_t value = 0;
        if (!parse_integer(trimmed(), value) || value < 0 || value > 0xFFFFFFFELL)
            xml_.fail(name + " " + in_quotes(text_), "the number of a vertex, from 0");
        corners_[static_cast<std::size_t>(name[1] - '1')] = value;
    }

    void set_placing(const std::string& name) {
        for (std::size_t k = 0; k < 3; ++k) {
            const char axis = "xyz"[k];
            if (name == std::string("delta") + axis) moves_[k] = number(name);
            if (name == std::string("r") + axis) turns_deg_[k] = number(name);
        }
    }

    void add_vertex() {
        if (object_ == nullptr) return;
        if (object_->mesh.positions_mm.size() % kStopEvery == 0) run_.throw_if_stopped();
        object_->mesh.positions_mm.emplace_back(place_.value[0], place_.value[1], place_.value[2]);
    }

    void keep_color(std::string_view parent) {
        if (!color_.sound) {
            skipped_.insert("colours given as formulas");
            return;
        }
        const Rgb8 color = {color_from_unit(color_.value[0]), color_from_unit(color_.value[1]),
                            color_from_unit(color_.value[2])};
        if (parent == "material") document_.materials[material_] = color;
        if (object_ == nullptr) return;
        if (parent == "object") object_->color = color;
        if (parent == "volume" && volume_open_) object_->volumes.back().color = color;
        if (parent == "triangle") triangle_color_ = color;
        // The colour stands before or behind the coordinates of its vertex.
        if (parent == "vertex") {
            object_->vertex_colors.resize(vertex_ + std::size_t{1});
            object_->vertex_colors[vertex_] = color;
        }
    }

    void add_triangle() {
        if (object_ == nullptr || !volume_open_) return;
        if (object_->mesh.triangles.size() % kStopEvery == 0) run_.throw_if_stopped();
        for (std::size_t k = 0; k < 3; ++k)
            if (corners_[k] < 0) xml_.fail("a triangle without v" + std::to_string(k + 1), "three corners");
        if (triangle_color_) {
            object_->triangle_colors.resize(object_->mesh.triangles.size());
            object_->triangle_colors.push_back(triangle_color_);
        }
        object_->mesh.triangles.push_back({static_cast<std::uint32_t>(corners_[0]),
                                           static_cast<std::uint32_t>(corners_[1]),
                                           static_cast<std::uint32_t>(corners_[2])});
    }

    void close_volume() {
        if (object_ == nullptr || !volume_open_) return;
        Volume& volume = object_->volumes.back();
        volume.triangle_count = static_cast<std::uint32_t>(object_->mesh.triangles.size()) - volume.first_triangle;
        volume_open_ = false;
    }

    /// Turned about x, then y, then z, then moved.
    void close_instance() {
        const double rad = std::numbers::pi / 180.0;
        const Eigen::Affine3d turned(Eigen::AngleAxisd(turns_deg_[2] * rad, Vec3::UnitZ()) *
                                     Eigen::AngleAxisd(turns_deg_[1] * rad, Vec3::UnitY()) *
                                     Eigen::AngleAxisd(turns_deg_[0] * rad, Vec3::UnitX()));
        instance_.transform = Eigen::Translation3d(moves_[0], moves_[1], moves_[2]) * turned;
        constellation_->push_back(instance_);
    }

    void keep_name(std::string_view parent) {
        if (object_ == nullptr) return;
        if (parent == "object") object_->name = trimmed();
        if (parent == "volume" && volume_open_) object_->volumes.back().name = trimmed();
    }

    void check_corners() {
        const std::size_t vertices = object_->mesh.positions_mm.size();
        for (std::size_t t = 0; t < object_->mesh.triangles.size(); ++t)
            for (const std::uint32_t v : object_->mesh.triangles[t])
                if (v >= vertices)
                    xml_.fail("triangle " + std::to_string(t) + " with vertex " + std::to_string(v),
                              "one below " + std::to_string(vertices) + ", the number of vertices");
    }

    XmlReader xml_;
    const RunControl& run_;
    Document document_;
    bool root_seen_ = false;
    std::vector<std::string> path_;
    std::string text_;
    std::string metadata_type_;
    std::string material_;
    Object* object_ = nullptr;  ///< open; none elsewhere
    bool volume_open_ = false;
    std::vector<Instance>* constellation_ = nullptr;
    Instance instance_;
    std::array<double, 3> moves_{};
    std::array<double, 3> turns_deg_{};
    Numbers place_;
    Numbers color_;
    std::array<std::int64_t, 3> corners_{};
    std::optional<Rgb8> triangle_color_;
    std::uint32_t vertex_ = 0;  ///< in hand
    std::set<std::string> skipped_;
};

}  // namespace

Document read_document(std::string_view xml, std::string_view source, const RunControl& run) {
    Handler handler(source, run);
    handler.xml().feed(xml);
    handler.xml().finish();
    return handler.take();
}

}  // namespace fretwork::amf
