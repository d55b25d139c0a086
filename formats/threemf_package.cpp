#include "formats/threemf_package.h"

#include "formats/parse_error.h"
#include "formats/threemf_model_reader.h"
#include "formats/threemf_names.h"
#include "formats/xml_reader.h"

namespace fretwork::threemf {
namespace {

constexpr std::uint64_t kMaxRelationsBytes = 8 << 20;
constexpr std::string_view kRelationsSpace = "http://schemas.openxmlformats.org/package/2006/relationships";

/// Picks the target of the first relationship of the wanted type.
class RelationFinder : public XmlHandler {
  public:
    explicit RelationFinder(std::string_view wanted) : wanted_(wanted) {}

    void start(const XmlElement& e) override {
        if (!target.empty() || e.space != kRelationsSpace || e.name != "Relationship") return;
        if (e.find("Type") == wanted_ && e.find("TargetMode").value_or("Internal") != "External")
            target = e.find("Target").value_or("");
    }
    void end() override {}
    void text(std::string_view) override {}

    std::string target;

  private:
    std::string_view wanted_;
};

}  // namespace

std::string_view without_slash(std::string_view path) {
    return path.substr(path.starts_with('/') ? 1 : 0);
}

Package::Package(std::string_view bytes, std::string_view source) : source_(source), zip_(bytes, source) {
    find_model_part();
}

void Package::find_model_part() {
    RelationFinder finder(kModelRelation);
    if (zip_.contains(kRootRelationsPart))
        read_xml(zip_.read(kRootRelationsPart, kMaxRelationsBytes), source_ + ": " + std::string(kRootRelationsPart),
                 finder);
    model_part_ = without_slash(finder.target);
    if (model_part_.empty()) {
        model_part_ = kModelPart;
        if (zip_.contains(model_part_))
            warnings_.emplace_back("no relationship names the model part; took the usual one");
    }
    if (!zip_.contains(model_part_))
        fail_parse(source_, std::string(kRootRelationsPart), "no model part " + in_quotes(model_part_), "one");
    if (!zip_.contains(kContentTypesPart)) warnings_.emplace_back("the package has no [Content_Types].xml");
}

Model Package::read_model(std::string_view part, bool ignore_required, const RunControl& run) const {
    const ModelReadOptions options{ignore_required,
                                   [this](std::string_view path, std::uint64_t most) { return read_part(path, most); }};
    ModelReader reader(source_ + ": " + std::string(without_slash(part)), options, run);
    zip_.read_blocks(without_slash(part), [&](std::string_view block) {
        run.throw_if_stopped();
        reader.feed(block);
    });
    return reader.finish();
}

std::string Package::read_part(std::string_view path, std::uint64_t max_bytes) const {
    return zip_.read(without_slash(path), max_bytes);
}

bool Package::contains(std::string_view path) const {
    return zip_.contains(without_slash(path));
}

}  // namespace fretwork::threemf
