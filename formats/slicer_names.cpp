#include "formats/slicer_names.h"

#include "core/base/error.h"
#include "formats/prusa_config_edit.h"
#include "formats/text_scanner.h"
#include "formats/xml_reader.h"

namespace fretwork::threemf {
namespace {

constexpr std::uint64_t kMaxConfigBytes = 8 << 20;
constexpr std::string_view kBambuConfigPart = "Metadata/model_settings.config";

/// `<config><object id=""><metadata key="name" value=""/>`, in both.
class NameCollector : public XmlHandler {
  public:
    void start(const XmlElement& e) override {
        ++depth_;
        if (depth_ == 2) {
            std::int64_t id = 0;
            const bool sound = e.name == "object" && parse_integer(e.find("id").value_or(""), id) && id > 0;
            object_ = sound ? static_cast<ResourceId>(id) : 0;
        }
        if (depth_ == 3 && object_ != 0 && e.name == "metadata" && e.find("key") == "name")
            names.emplace(object_, e.find("value").value_or(""));
    }
    void end() override { --depth_; }
    void text(std::string_view) override {}

    std::map<ResourceId, std::string> names;

  private:
    int depth_ = 0;
    ResourceId object_ = 0;
};

}  // namespace

std::map<ResourceId, std::string> slicer_names(const Package& package) {
    NameCollector collector;
    for (const std::string_view part : {kPrusaConfigPart, kBambuConfigPart}) {
        if (!package.contains(part)) continue;
        try {
            read_xml(package.read_part(part, kMaxConfigBytes), part, collector);
        } catch (const InvalidInput&) {
            return {};
        }
    }
    return collector.names;
}

}  // namespace fretwork::threemf
