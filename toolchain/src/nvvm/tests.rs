//! What each construct becomes, and that libNVVM and ptxas accept it.
