#pragma once

namespace evo::io::hdf5 {

/// Registers h5py's LZF compression (filter 32000) with HDF5, which does not bring it. Debian 12's plugin for it,
/// hdf5-plugin-lzf, lacks the decoder and does not load; liblzf decodes here. May be called again.
void RegisterLzf();

}  // namespace evo::io::hdf5
