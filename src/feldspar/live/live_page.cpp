#include "feldspar/live/live_page.hpp"

#include <nlohmann/json.hpp>

#include "feldspar/base/error.hpp"
#include "feldspar/output/html_page.hpp"
#include "feldspar/output/report_assets.hpp"

namespace feldspar {
namespace {

// Replaces the one place of a page that our own writer put there.
void put(std::string& page, const std::string& place, std::size_t from, const std::string& text) {
    const std::size_t found = page.find(place, from);
    if (found == std::string::npos) throw OutputError("the report has no place for the live view: '" + place + "'");
    page.replace(found, place.size(), text);
}

}  // namespace

std::string live_page(const std::string& report, const std::string& name, const std::string& over, const LiveWords& words) {
    std::string page = report.empty() ? html_page(name, nlohmann::ordered_json::object(), "") : report;
    const nlohmann::ordered_json live = {{"name", name},         {"over", over},     {"report", !report.empty()},
                                         {"whole", words.whole}, {"one", words.one}, {"keeps_ended", words.keeps_ended}};
    const std::string end = "</body>";
    put(page, end, page.rfind(end),
        std::string("<style>\n") + asset_live_css + "</style>\n<script type=\"application/json\" id=\"live\">" +
            script_json(live) + "</script>\n<script>\n" + asset_live_js + "</script>\n" + end);
    const std::string policy = "default-src 'none';";  // it may ask where it comes from, and nobody else
    put(page, policy, 0, policy + " connect-src 'self';");
    return page;
}

}  // namespace feldspar
