// sinew.hpp  Everything public in one include.
#pragma once
#include "sinew/asset.hpp"
#include "sinew/contact_source.hpp"
#include "sinew/event.hpp"
#include "sinew/export.h"
#include "sinew/id.hpp"
#include "sinew/isa.hpp"
#include "sinew/matrix.hpp"
#include "sinew/read.hpp"
#include "sinew/status.hpp"
#include "sinew/types.hpp"
#include "sinew/version.h"
#include "sinew/world.hpp"
