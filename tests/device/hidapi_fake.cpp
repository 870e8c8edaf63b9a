// A stand-in for libhidapi-hidraw: a program's own definitions take precedence over a shared library's, so the
// adapter's own code runs without hardware. Like hidapi it keeps a global text without a lock, so that a thread
// sanitizer finds callers that do not take turns.
#include "tests/device/hidapi_fake.h"

#include <algorithm>
#include <cstring>

#include <hidapi/hidapi.h>

struct hid_device_ {
    std::string  path;
    std::wstring error;
};

namespace palp {

HidapiFake& hidapiFake()
{
    static HidapiFake fake;
    return fake;
}

} // namespace palp

namespace {

std::wstring globalError; // without a lock on purpose

char* copied(const std::string& text)
{
    char* copy = new char[text.size() + 1];
    std::memcpy(copy, text.c_str(), text.size() + 1);
    return copy;
}

wchar_t* copied(const std::wstring& text)
{
    wchar_t* copy = new wchar_t[text.size() + 1];
    std::copy_n(text.c_str(), text.size() + 1, copy);
    return copy;
}

} // namespace

extern "C" {

int hid_init()
{
    globalError.clear();
    return palp::hidapiFake().starts ? 0 : -1;
}

hid_device_info* hid_enumerate(unsigned short, unsigned short)
{
    globalError            = L"nothing to complain about";
    hid_device_info*  list = nullptr;
    hid_device_info** end  = &list;
    for (const palp::HidapiFake::Listed& listed : palp::hidapiFake().devices) {
        *end               = new hid_device_info{}; // all pointers null: a real entry may lack any text
        (*end)->path       = copied(listed.path);
        (*end)->vendor_id  = listed.vendor;
        (*end)->product_id = listed.product;
        (*end)->usage_page = listed.usagePage;
        (*end)->usage      = listed.usage;
        if (!listed.model.empty()) (*end)->product_string = copied(listed.model);
        ++palp::hidapiFake().entries;
        end = &(*end)->next;
    }
    return list;
}

void hid_free_enumeration(hid_device_info* list)
{
    while (list) {
        hid_device_info* next = list->next;
        delete[] list->path;
        delete[] list->product_string;
        delete list;
        --palp::hidapiFake().entries;
        list = next;
    }
}

hid_device* hid_open_path(const char* path)
{
    ++palp::hidapiFake().opened;
    if (!palp::hidapiFake().openError.empty()) {
        globalError = palp::hidapiFake().openError;
        return nullptr;
    }
    ++palp::hidapiFake().ports;
    return new hid_device{path, {}};
}

void hid_close(hid_device* device)
{
    --palp::hidapiFake().ports;
    delete device;
}

int hid_read_timeout(hid_device* device, unsigned char* data, std::size_t size, int milliseconds)
{
    palp::hidapiFake().waited = milliseconds;
    if (palp::hidapiFake().broken) {
        device->error = L"gone";
        return -1;
    }
    const std::vector<std::uint8_t>& report = palp::hidapiFake().report;
    const std::size_t                length = std::min(size, report.size());
    std::copy_n(report.begin(), length, data);
    return int(length);
}

int hid_write(hid_device* device, const unsigned char* data, std::size_t size)
{
    if (palp::hidapiFake().broken) {
        device->error = L"gone";
        return -1;
    }
    palp::hidapiFake().written.assign(data, data + size);
    return int(size);
}

const wchar_t* hid_error(hid_device* device)
{
    return device ? device->error.c_str() : globalError.c_str();
}

const char* hid_version_str()
{
    return "0.13.1 (fake)";
}
}
