// report.html: one file with its data, styles and scripts inside; it opens from disk and asks the network for nothing.
#include <fmt/format.h>

#include <string>

#include "feldspar/output/html_page.hpp"
#include "feldspar/output/report_assets.hpp"
#include "feldspar/output/report_data.hpp"
#include "feldspar/output/results.hpp"

namespace feldspar {

namespace {

constexpr std::size_t largest_report_B = 9'500'000;  ///< more is slow to open and to send

std::string script_block(const std::string& id, const std::string& text) {
    return fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, text);
}

}  // namespace

void write_report(const RunDirectory& directory, const Job& job, std::span<const TestResult> results,
                  const PropertySummary& properties, const Provenance& provenance, bool complete,
                  std::span<const FailedTest> failed) {
    nlohmann::ordered_json data = report_data(job, results, properties, provenance, complete, failed);
    std::string blocks;
    data["patterns"] = nlohmann::ordered_json::array();
    if (job.has_variants()) {
        const auto patterns = report_patterns(results);
        for (std::size_t p = 0; p < patterns.size(); ++p) {
            data["patterns"].push_back(patterns[p].meta);
            blocks += script_block(fmt::format("pattern-{}", p), patterns[p].block);
        }
    }
    data["fields"] = nlohmann::ordered_json::array();
    const std::size_t used = script_json(data).size() + blocks.size();
    const auto fields = report_fields(results, used < largest_report_B ? largest_report_B - used : 0);
    for (std::size_t f = 0; f < fields.size(); ++f) {
        data["fields"].push_back(fields[f].meta);
        blocks += script_block(fmt::format("fields-{}", f), fields[f].block);
    }
    HtmlPage page(asset_report_html);
    page.fill("title", escaped(job.name));
    page.fill("uplot_css", asset_uPlot_min_css);
    page.fill("css", asset_report_css);
    page.fill("data", script_json(with_methods(data)));
    page.fill("fields", blocks);
    page.fill("uplot_js", asset_uPlot_iife_min_js);
    page.fill("charts_js", asset_charts_js);
    page.fill("page_js", asset_page_js);
    page.fill("viewer_js", asset_viewer_js);
    page.fill("compare_js", asset_compare_js);
    page.fill("report_js", asset_report_js);
    directory.write_text("report.html", page.text());
}

}  // namespace feldspar
