// SPDX-License-Identifier: MIT
#include "reports/record.hpp"
