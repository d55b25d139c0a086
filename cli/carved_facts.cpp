#include "cli/carved_facts.h"

#include <algorithm>
#include <variant>

#include "cli/pattern_options.h"
#include "core/base/error.h"
#include "core/pipeline/object_settings.h"
#include "core/pipeline/region_schema.h"
#include "core/pipeline/settings_schema.h"
#include "formats/run_source.h"
#include "formats/spec_toml_reader.h"
#include "formats/threemf_facts.h"

namespace fretwork::cli {
namespace {

FactValue fact_of(const SettingValue& value) {
    return std::visit([](const auto& held) { return FactValue(held); }, value);
}

Facts file_facts(const RunFile& file) {
    return {{{"path", file.path}, {"sha256", file.sha256}, {"in_package", !file.bytes.empty()}}};
}

}  // namespace

void add_settings_facts(const Settings& settings, const std::string& group, Facts& facts) {
    for (const SettingInfo& info : all_settings())
        if (const auto value = info.get(settings); value && value != info.get(Settings{}))
            facts.add(group + "changed." + info.key, fact_of(*value));
    const std::vector<SettingTable> tables = tables_from(settings);
    for (const TableInfo& table : table_infos())
        facts.add(group + table.array,
                  static_cast<std::int64_t>(std::ranges::count(tables, table.array, &SettingTable::array)));
    facts.add(group + std::string(kObjectArray), static_cast<std::int64_t>(settings.objects.size()));
}

void add_carved_facts(const ModelBytes& package, Facts& facts) {
    try {
        if (!has_run_source(package.bytes, package.name)) return;
        const RunSource run = read_run_source(package.bytes, package.name);
        facts.add("carved.version", run.version);
        for (const auto& [name, value] : file_facts(run.model).entries) facts.add("carved.model." + name, value);
        facts.add("carved.model.format", run.model_format);
        std::vector<Facts> pictures;
        for (const RunFile& picture : run.pictures) pictures.push_back(file_facts(picture));
        facts.add("carved.pictures", pictures);
        add_settings_facts(settings_of({}, read_spec_toml(run.request_toml, package.name + ": request.toml")),
                           "carved.spec.", facts);
        add_run_facts(read_run_report(package.bytes, package.name), "carved.", facts);
    } catch (const Error& damage) {
        facts.add("carved.damaged", std::string(damage.what()));
    }
}

}  // namespace fretwork::cli
