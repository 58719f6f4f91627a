#include "feldspar/study/point_results.hpp"

#include <map>
#include <set>

namespace feldspar {

std::vector<PointResults> point_results(const Study& study, const Ledger& ledger) {
    std::vector<std::string> ids;
    for (const Run& run : study.runs) ids.push_back(run.id);
    std::map<std::string, RunRecord> records;
    for (RunRecord& record : ledger.find(ids)) {
        std::string id = record.id;
        records.emplace(std::move(id), std::move(record));
    }
    std::vector<PointResults> points(study.points.size());
    for (std::size_t p = 0; p < points.size(); ++p) points[p].values = study.points[p].values;
    for (const Run& run : study.runs) {
        PointResults& point = points[run.point];
        const auto found = records.find(run.id);
        if (found == records.end() || found->second.state == RunState::running)
            ++point.missing;
        else if (found->second.state == RunState::failed)
            point.failed.push_back(found->second);
        else
            point.results.push_back(result_of(found->second));
    }
    for (PointResults& point : points) point.properties = summarise(point.results);
    return points;
}

}  // namespace feldspar
