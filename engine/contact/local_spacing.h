#pragma once
#include "engine/cloud/local_spacing.h" // where it is; this name stays for those who include it
