// The module feldspar._core: the library as Python sees it. What is convenient is written in Python, beside it.
#include "common.hpp"
#include "feldspar/output/results.hpp"

PYBIND11_MODULE(_core, m) {
    using namespace feldspar::python;
    m.doc() = "The library behind the package feldspar.";
    translate_errors();
    const feldspar::Provenance provenance = feldspar::collect_provenance({}, 1);
    m.attr("version") = provenance.version;
    m.attr("commit") = provenance.commit;
    bind_jobs(m);
    bind_specimens(m);
    bind_results(m);
    bind_observers(m);
    bind_running(m);
    bind_studies(m);
}
