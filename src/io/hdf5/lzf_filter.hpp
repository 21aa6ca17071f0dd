#pragma once

namespace evo::io::hdf5 {

/// Teaches HDF5 to read h5py's LZF compression (filter 32000), which no stock C library can. Debian has a plugin for
/// it, hdf5-plugin-lzf, but the one of Debian 12 lacks its decoder and does not load. May be called again.
void RegisterLzf();

}  // namespace evo::io::hdf5
