// A substitute of liblsl for tests: the functions that Palpate calls, with the behaviour that its manual promises.
// What arrives is written to the file that FAKE_LSL_LOG names.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>

namespace {

struct Info {
    std::string name, type;
    int         channels, format;
    double      rate;
    std::string description;
};

std::mutex mutex; // of the log

void log(const std::string& line)
{
    const std::lock_guard lock(mutex);
    if (const char* path = std::getenv("FAKE_LSL_LOG"))
        if (std::FILE* file = std::fopen(path, "a")) {
            std::fputs((line + "\n").c_str(), file);
            std::fclose(file);
        }
}

} // namespace

extern "C" {

void* lsl_create_streaminfo(const char* name, const char* type, std::int32_t channels, double rate, int format,
                            const char* source)
{
    if (std::string(source).empty()) return nullptr;
    return new Info{name, type, channels, format, rate, ""};
}
void lsl_destroy_streaminfo(void* info)
{
    delete static_cast<Info*>(info);
}
void* lsl_get_desc(void* info)
{
    return info;
}
void* lsl_append_child(void* element, const char* name)
{
    static_cast<Info*>(element)->description += std::string(" <") + name + ">";
    return element;
}
void* lsl_append_child_value(void* element, const char* name, const char* value)
{
    static_cast<Info*>(element)->description += std::string(" ") + name + "=" + value;
    return element;
}
void* lsl_create_outlet(void* info, std::int32_t /*chunk*/, std::int32_t seconds)
{
    const Info& of = *static_cast<Info*>(info);
    if (seconds < 1) return nullptr;
    log("outlet " + of.name + "; " + of.type + "; " + std::to_string(of.channels) + " channels of format " +
        std::to_string(of.format) + "; " + std::to_string(int(of.rate)) + " Hz;" + of.description);
    return new Info(of); // an outlet has a copy of its description
}
void lsl_destroy_outlet(void* outlet)
{
    log("end of " + static_cast<Info*>(outlet)->name);
    delete static_cast<Info*>(outlet);
}
std::int32_t lsl_push_sample_dtp(void* outlet, const double* values, double time, std::int32_t through)
{
    std::string line = "sample " + std::to_string(time) + " " + std::to_string(through) + ":";
    for (int k = 0; k < static_cast<Info*>(outlet)->channels; ++k) line.append(" ").append(std::to_string(values[k]));
    log(line);
    return 0;
}
std::int32_t lsl_push_sample_strtp(void* outlet, const char** texts, double time, std::int32_t /*through*/)
{
    log("text " + static_cast<Info*>(outlet)->name + " " + std::to_string(time) + ": " + texts[0]);
    return 0;
}
double lsl_local_clock()
{
    return 5000;
} // a clock that has nothing to do with the system's
}
