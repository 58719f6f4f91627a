#include "feldspar/study/growing_page.hpp"

#include <algorithm>

#include "feldspar/base/error.hpp"
#include "feldspar/study/point_results.hpp"
#include "feldspar/study/study_report.hpp"

namespace feldspar {

GrowingPage::GrowingPage(const Study& study, const Ledger& ledger, LiveBoard& board, std::chrono::milliseconds pause)
    : study_(study), ledger_(ledger), board_(board), pause_(pause) {
    write();
}

void GrowingPage::renew_if_due() {
    if (old_ && !given_up_ && Clock::now() >= not_before_) write();
}

void GrowingPage::write() {
    const Clock::time_point begin = Clock::now();
    try {
        write_study_report(study_, point_results(study_, ledger_), study_page(study_));
        board_.report(study_page(study_));
    } catch (const OutputError&) {
        given_up_ = true;
    }
    old_ = false;
    const Clock::time_point end = Clock::now();
    not_before_ = end + std::max(pause_, 50 * (end - begin));
}

}  // namespace feldspar
