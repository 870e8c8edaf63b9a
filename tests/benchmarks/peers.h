#pragma once
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace palp::bench {

/// Prints one line per comparison: benchmarks whose names differ only after the last '/' do the same work. The name
/// after it says who; whoever begins with "palpate" is us, and the ratio is that of the fastest other to us.
///
/// Benchmarks call SetItemsProcessed; times are processor time per item, medians and quartiles of the repetitions.
class PeerTable : public benchmark::BenchmarkReporter {
public:
    bool ReportContext(const Context&) override { return true; }

    void ReportRuns(const std::vector<Run>& runs) override
    {
        for (const Run& run : runs) {
            if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
            const std::string name  = run.run_name.function_name;
            const std::size_t slash = name.rfind('/');
            times_[name.substr(0, slash)][name.substr(slash + 1)].push_back(1e9 / run.counters.at("items_per_second"));
        }
    }

    void Finalize() override
    {
        std::printf("%-34s %-26s %12s %12s %12s   %s\n", "comparison", "who", "lower [ns]", "median [ns]", "upper [ns]",
                    "best other / palpate");
        for (auto& [work, peers] : times_) {
            double ours = 0, others = 0;
            for (auto& [who, times] : peers) {
                std::sort(times.begin(), times.end());
                const double median = times[times.size() / 2];
                double&      best   = who.starts_with("palpate") ? ours : others;
                best                = best == 0 ? median : std::min(best, median);
                std::printf("%-34s %-26s %12.1f %12.1f %12.1f\n", work.c_str(), who.c_str(), times[times.size() / 4],
                            median, times[times.size() * 3 / 4]);
            }
            if (ours > 0 && others > 0) std::printf("%-34s %-26s %42.2f\n", work.c_str(), "ratio", others / ours);
        }
    }

private:
    std::map<std::string, std::map<std::string, std::vector<double>>> times_; ///< [ns] per item, by work and by who
};

/// Runs what is registered, the peers of all comparisons interleaved at random, so that other work on the machine
/// disturbs them alike. Options of Google Benchmark work and win over the defaults set here.
inline int runPeers(int argc, char** argv)
{
    static char        interleave[] = "--benchmark_enable_random_interleaving=true";
    static char        repeat[]     = "--benchmark_repetitions=11";
    static char        shortest[]   = "--benchmark_min_time=0.03";
    std::vector<char*> options{argv[0], interleave, repeat, shortest};
    options.insert(options.end(), argv + 1, argv + argc);
    int count = static_cast<int>(options.size());
    benchmark::Initialize(&count, options.data());
    PeerTable table;
    benchmark::RunSpecifiedBenchmarks(&table);
    return 0;
}

} // namespace palp::bench
