//! softdock: spacecraft docking and grasp scenarios.
