#include "engine/session/failure_teller.h"

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

namespace palp {
namespace {

/// Returns the reason without its numbers and what follows them, which are units most often.
std::string kindOf(const std::string& reason)
{
    std::istringstream words(reason);
    std::string        kind;
    bool               afterNumber = false;
    for (std::string word; words >> word;) {
        const bool number = word.find_first_of("0123456789") != std::string::npos;
        if (!number && !afterNumber) kind += word + " ";
        afterNumber = number;
    }
    return kind;
}

class FailureTeller {
public:
    FailureTeller(PatchSolver solver, std::function<void(const std::string&)> tell)
        : solver_(std::move(solver)), tell_(std::move(tell))
    {
    }

    DeformationAnswer operator()(const Touch& touch, double lead)
    {
        try {
            DeformationAnswer answer = solver_(touch, lead);
            if (!answer.takeover.empty()) tellOnce(kindOf(answer.takeover), answer.takeover);
            if (!answer.update && !answer.why.empty()) note(answer.why); // no reason: nobody touches
            solved_ = solved_ || answer.update;
            return answer;
        } catch (const std::exception& error) { // the session's to catch, too
            note(error.what());
            throw;
        }
    }

private:
    void note(const std::string& why)
    {
        const std::string start =
            solved_ ? "the plate cannot be solved where the hand touches, which feels its last answer "
                      "for a quarter of a second more: "
                    : "the hand touches and feels nothing after a quarter of a second, because the plate cannot be "
                      "solved: ";
        tellOnce(kindOf(start + why), start + why);
    }

    void tellOnce(const std::string& kind, const std::string& sentence)
    {
        if (std::ranges::find(told_, kind) != told_.end()) return;
        told_.push_back(kind);
        tell_(sentence);
    }

    PatchSolver                             solver_;
    std::function<void(const std::string&)> tell_;
    std::vector<std::string>                told_; ///< kinds of sentences
    bool                                    solved_ = false;
};

} // namespace

PatchSolver tellingFailures(PatchSolver solver, std::function<void(const std::string&)> tell)
{
    return FailureTeller(std::move(solver), std::move(tell));
}

} // namespace palp
