// Reads a job, packs its grains and says how many there are.
#include <cstdio>
#include <feldspar/job/job.hpp>
#include <feldspar/specimen/specimen.hpp>

int main(int, char** arguments) {
    const feldspar::Job job = feldspar::read_job(arguments[1]);
    const feldspar::Specimen specimen = feldspar::make_specimen(job.specimen, job.seeds.front());
    std::printf("%d grains, %d contacts\n", specimen.quality.grains, specimen.quality.contacts);
}
