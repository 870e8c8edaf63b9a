#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <thread>

// sanitizers_bite MISTAKE: makes the mistake. A build under that sanitizer ends here with a failure; where this program
// ends well, its tests fail, because then no other test could.

namespace {

int shared = 0;

void readBehind(int count)
{
    const int* const one = new int[1]{count};
    std::printf("%d\n", one[count]);
    delete[] one;
}

void overflow(int count)
{
    std::printf("%d\n", std::numeric_limits<int>::max() + count);
}

void race()
{
    std::thread other([] { ++shared; });
    ++shared;
    other.join();
    std::printf("%d\n", shared);
}

} // namespace

int main(int count, char** arguments)
{
    const std::string_view mistake = count > 1 ? arguments[1] : "";
    if (mistake == "address") readBehind(count - 1);
    if (mistake == "undefined") overflow(count);
    if (mistake == "thread") race();
    return 0;
}
